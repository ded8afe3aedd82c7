use core::fmt;

/// First bytes of each forest file: its type and the version of its format.
const MAGIC: &[u8] = b"apex-forest 1\n";

/// Bytes of a node: feature, offset of the right branch, threshold or value.
const NODE: usize = 8;

/// Feature number of a leaf.
const LEAF: u16 = u16::MAX;

/// Forest of decision trees for two classes, read where it lies: without copies and without a heap.
///
/// Each tree sorts the input into a leaf with a value. The sum of the values of all trees is the probability of the
/// class. Random forests (Breiman 2001) and boosted trees (Freund and Schapire 1997) are forests.
///
/// The bytes consist of a header (`apex-forest 1`, seed, sizes, provenance), the first node of each tree, and the nodes
/// in preorder, in little-endian order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Forest<'a> {
    seed: u64,
    inputs: usize,
    provenance: &'a str,
    roots: &'a [u8],
    nodes: &'a [u8],
}

/// Error of bytes that are not a forest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BadForest {
    /// The bytes do not begin like a forest.
    Magic,
    /// The bytes end too early or too late.
    Length,
    /// A tree is damaged: a branch leads out of it, an input does not exist, or a value is not finite.
    Tree,
    /// The forest has another number of inputs than there are features.
    Inputs,
}

impl fmt::Display for BadForest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Magic => "the bytes are not a forest: they do not begin with `apex-forest 1`",
            Self::Length => "the forest is damaged: its length is not what its header says",
            Self::Tree => "the forest is damaged: a tree has a branch to nowhere, or a value that is not finite",
            Self::Inputs => "the forest is for other features: it has another number of inputs",
        })
    }
}

impl core::error::Error for BadForest {}

/// Node of a tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TreeNode {
    /// End of a branch with its value.
    Leaf(f32),
    /// Branch by a feature.
    Split {
        /// Number of the feature.
        feature: u16,
        /// Largest value that belongs to the left branch, which begins with the next node.
        threshold: f32,
        /// Number of nodes from here to the right branch.
        right: u16,
    },
}

impl TreeNode {
    /// Bytes of the node in a forest.
    pub fn to_bytes(self) -> [u8; NODE] {
        let (feature, right, number) = match self {
            Self::Leaf(value) => (LEAF, 0, value),
            Self::Split { feature, threshold, right } => (feature, right, threshold),
        };
        let ([a, b], [c, d], [e, f, g, h]) = (feature.to_le_bytes(), right.to_le_bytes(), number.to_le_bytes());
        [a, b, c, d, e, f, g, h]
    }

    const fn from_bytes(bytes: [u8; NODE]) -> Self {
        let [a, b, c, d, e, f, g, h] = bytes;
        let number = f32::from_le_bytes([e, f, g, h]);
        match u16::from_le_bytes([a, b]) {
            LEAF => Self::Leaf(number),
            feature => Self::Split { feature, threshold: number, right: u16::from_le_bytes([c, d]) },
        }
    }
}

/// Takes `N` bytes off the front.
fn take<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (first, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*first)
}

impl<'a> Forest<'a> {
    /// Reads a forest.
    ///
    /// # Errors
    /// If the bytes are not a sound forest.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, BadForest> {
        let content = bytes.strip_prefix(MAGIC).ok_or(BadForest::Magic)?;
        let forest = Self::split(content).ok_or(BadForest::Length)?;
        if forest.is_sound() { Ok(forest) } else { Err(BadForest::Tree) }
    }

    fn split(mut rest: &'a [u8]) -> Option<Self> {
        let seed = u64::from_le_bytes(take(&mut rest)?);
        let inputs = usize::from(u16::from_le_bytes(take(&mut rest)?));
        let trees = u32::from_le_bytes(take(&mut rest)?) as usize;
        let nodes = u32::from_le_bytes(take(&mut rest)?) as usize;
        let text = usize::from(u16::from_le_bytes(take(&mut rest)?));
        let (provenance, rest) = rest.split_at_checked(text)?;
        let (roots, nodes_bytes) = rest.split_at_checked(trees.checked_mul(4)?)?;
        let provenance = core::str::from_utf8(provenance).ok()?;
        let whole = nodes.checked_mul(NODE)? == nodes_bytes.len();
        whole.then_some(Self { seed, inputs, provenance, roots, nodes: nodes_bytes })
    }

    fn is_sound(&self) -> bool {
        let count = self.nodes.len() / NODE;
        let sound = |(at, node): (usize, TreeNode)| match node {
            TreeNode::Leaf(value) => value.is_finite(),
            TreeNode::Split { feature, threshold, right } => {
                let inside = right > 1 && at + usize::from(right) < count;
                inside && usize::from(feature) < self.inputs && threshold.is_finite()
            }
        };
        let nodes = (0..count).map_while(|at| Some((at, self.node(at)?)));
        nodes.into_iter().all(sound) && self.roots().all(|root| root < count)
    }

    fn roots(&self) -> impl Iterator<Item = usize> + 'a {
        self.roots.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize)
    }

    fn node(&self, at: usize) -> Option<TreeNode> {
        self.nodes.get(at * NODE..)?.first_chunk().copied().map(TreeNode::from_bytes)
    }

    /// Number of inputs.
    pub const fn inputs(&self) -> usize {
        self.inputs
    }

    /// Returns the forest if it has this number of inputs.
    ///
    /// # Errors
    /// If it has another number.
    pub const fn with_inputs(self, inputs: usize) -> Result<Self, BadForest> {
        if self.inputs == inputs { Ok(self) } else { Err(BadForest::Inputs) }
    }

    /// Number of trees.
    pub const fn trees(&self) -> usize {
        self.roots.len() / 4
    }

    /// Seed of the training.
    pub const fn seed(&self) -> u64 {
        self.seed
    }

    /// Training data and program of the training.
    pub const fn provenance(&self) -> &'a str {
        self.provenance
    }

    /// Probability of the class, from 0 to 1. `None` if the number of inputs is wrong or an input is not a number.
    pub fn probability(&self, inputs: &[f32]) -> Option<f32> {
        if inputs.len() != self.inputs || inputs.iter().any(|x| x.is_nan()) {
            return None;
        }
        let mut sum = 0.0;
        for mut at in self.roots() {
            // Ends, as both branches lie behind their node.
            while let Some(node) = self.node(at) {
                match node {
                    TreeNode::Leaf(value) => {
                        sum += value;
                        break;
                    }
                    TreeNode::Split { feature, threshold, right } => {
                        let is_left = inputs[usize::from(feature)] <= threshold;
                        at += if is_left { 1 } else { usize::from(right) };
                    }
                }
            }
        }
        Some(sum.clamp(0.0, 1.0))
    }
}

/// Writes the bytes of a forest: for each tree its nodes in preorder. Texts and trees beyond the limits of the format
/// (65535 bytes, inputs or nodes in a branch) are cut off or give bytes that [`Forest::from_bytes`] rejects.
#[cfg(feature = "std")]
pub fn forest_bytes(
    provenance: &str,
    seed: u64,
    inputs: usize,
    trees: &[std::vec::Vec<TreeNode>],
) -> std::vec::Vec<u8> {
    let fits = |end: &usize| provenance.is_char_boundary(*end);
    let length = (0..=provenance.len().min(usize::from(u16::MAX))).rev().find(fits).unwrap_or(0);
    let count: usize = trees.iter().map(std::vec::Vec::len).sum();
    let mut bytes = MAGIC.to_vec();
    bytes.reserve(length + 4 * trees.len() + NODE * count);
    bytes.extend(seed.to_le_bytes());
    bytes.extend((inputs as u16).to_le_bytes());
    bytes.extend((trees.len() as u32).to_le_bytes());
    bytes.extend((count as u32).to_le_bytes());
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(&provenance.as_bytes()[..length]);
    let mut first = 0_u32;
    for tree in trees {
        bytes.extend(first.to_le_bytes());
        first += tree.len() as u32;
    }
    bytes.extend(trees.iter().flatten().flat_map(|node| node.to_bytes()));
    bytes
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;

    fn stump(feature: u16, threshold: f32, low: f32, high: f32) -> Vec<TreeNode> {
        vec![TreeNode::Split { feature, threshold, right: 2 }, TreeNode::Leaf(low), TreeNode::Leaf(high)]
    }

    #[test]
    fn the_sum_of_the_leaves_is_the_probability() {
        let bytes = forest_bytes("a test", 7, 2, &[stump(0, 1.0, 0.0, 0.5), stump(1, -1.0, 0.3, 0.1)]);
        let forest = Forest::from_bytes(&bytes).expect("sound");
        assert_eq!((forest.inputs(), forest.trees(), forest.seed(), forest.provenance()), (2, 2, 7, "a test"));
        assert_eq!(forest.probability(&[2.0, 0.0]), Some(0.6));
        assert_eq!(forest.probability(&[1.0, -1.0]), Some(0.3));
        for odd in [&[0.0][..], &[0.0; 3], &[f32::NAN, 0.0]] {
            assert_eq!(forest.probability(odd), None);
        }
    }

    #[test]
    fn damaged_forests_are_errors() {
        let bytes = forest_bytes("a test", 7, 2, &[stump(0, 1.0, 0.0, 0.5)]);
        assert!((0..bytes.len()).all(|len| Forest::from_bytes(&bytes[..len]).is_err()));
        assert_eq!(Forest::from_bytes(b"GIF89a"), Err(BadForest::Magic));
        assert_eq!(Forest::from_bytes(&[&bytes[..], &[0]].concat()), Err(BadForest::Length));
        let leaf = TreeNode::Leaf(0.0);
        let tree = |feature, threshold, right| [vec![TreeNode::Split { feature, threshold, right }, leaf, leaf]];
        for odd in [tree(2, 0.0, 2), tree(0, 0.0, 3), tree(0, 0.0, 0), tree(0, f32::NAN, 2)] {
            assert_eq!(Forest::from_bytes(&forest_bytes("", 0, 2, &odd)), Err(BadForest::Tree), "{odd:?}");
        }
        // Any single damaged byte is an error or another forest, and never a panic or an endless loop.
        for at in 0..bytes.len() {
            let mut odd = bytes.clone();
            odd[at] ^= 0xff;
            if let Ok(forest) = Forest::from_bytes(&odd) {
                let _ = forest.probability(&vec![0.0; forest.inputs()]);
            }
        }
    }
}
