//! Hostile features: a case has one or two of them.

/// A hostile feature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Names of nodes.
    NodeNames,
    /// Names of graphs that are similar to generated names.
    GraphNames,
    /// Names of ports and parameters.
    PortNames,
    /// Constants, tuple structs and types with the names of nodes, graphs and generated items.
    RustNames,
    /// Types that do not exist, or have other type arguments.
    WrongTypes,
    /// Types without `Clone`, `Default`, `Debug` or `Send`, and types that are rare at ports.
    OddTypes,
    /// Trait bounds that are not met, and constants of types that cannot be inferred.
    Bounds,
    /// Numbers that do not fit, and values of other types.
    Values,
    /// Rust constants that are missing, private or of another type.
    Constants,
    /// Private nodes, modules and types.
    Visibility,
    /// Nodes that exist only on other machines, or only with features.
    Cfg,
    /// Attributes of nodes and of the crate.
    Attributes,
    /// Modifiers in unusual places.
    Modifiers,
    /// Tests: names, values, ports.
    Tests,
    /// Names of thread groups, and tests of programs with several.
    Threads,
    /// State machines: names, guards, values.
    Machines,
    /// Several source files that import each other.
    Files,
    /// Duplicate declarations.
    Twice,
}

/// All features.
pub const KINDS: [Kind; 18] = [
    Kind::NodeNames,
    Kind::GraphNames,
    Kind::PortNames,
    Kind::RustNames,
    Kind::WrongTypes,
    Kind::OddTypes,
    Kind::Bounds,
    Kind::Values,
    Kind::Constants,
    Kind::Visibility,
    Kind::Cfg,
    Kind::Attributes,
    Kind::Modifiers,
    Kind::Tests,
    Kind::Threads,
    Kind::Machines,
    Kind::Files,
    Kind::Twice,
];

impl Kind {
    /// `true` if the feature mostly causes errors, which the compiler has to find.
    pub const fn is_mostly_wrong(self) -> bool {
        matches!(self, Self::WrongTypes | Self::Values | Self::Constants | Self::Modifiers | Self::Twice)
    }
}
