//! Models of robots in the Unified Robot Description Format (URDF): their links and joints.

use super::{FrameName, JointPositions, MAX_TRANSFORMS, Pose3, Rotation, Transform, Transforms, frame_name};
use heapless::Vec as Fixed;
use roxmltree::{Document, Node, TextPos};
use std::{
    collections::BTreeMap,
    fmt, fs,
    path::{Path, PathBuf},
};

/// Error of a model of a robot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UrdfError {
    /// Path of the file.
    pub path: PathBuf,
    /// Line and column, counted from 1; `None` if the file could not be opened.
    pub place: Option<(u32, u32)>,
    /// Description of the error.
    pub message: String,
}

impl fmt::Display for UrdfError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.path.display())?;
        if let Some((line, column)) = self.place {
            write!(f, "{line}:{column}:")?;
        }
        write!(f, " {}", self.message)
    }
}

impl std::error::Error for UrdfError {}

/// Movement of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum JointKind {
    /// It does not.
    Fixed,
    /// It turns about this axis: `revolute` and `continuous`.
    Turning([f64; 3]),
    /// It slides along this axis: `prismatic`.
    Sliding([f64; 3]),
    /// It moves in more than one way: `floating` and `planar`. Its pose is not one of joint states.
    Free,
}

/// Joint of a robot, between two links.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Name.
    pub name: FrameName,
    /// Link in which the joint is.
    pub parent: FrameName,
    /// Link that moves.
    pub child: FrameName,
    /// Pose of the child in the parent when the joint is at 0.
    pub origin: Pose3,
    /// Movement.
    pub kind: JointKind,
    /// Joint that it follows, with the factor and the offset of its position, in rad or m.
    mimic: Option<(FrameName, f64, f64)>,
}

impl Joint {
    /// Pose of the child in the parent, when the joint is at this position, in rad or m.
    pub fn pose(&self, position: f64) -> Pose3 {
        let moved = match self.kind {
            JointKind::Fixed | JointKind::Free => Pose3::default(),
            JointKind::Turning(axis) => Pose3::new([0.0; 3], Rotation::about(axis, position)),
            JointKind::Sliding(axis) => Pose3::new(axis.map(|c| c * position), Rotation::NONE),
        };
        self.origin.compose(&moved)
    }

    /// Position among those of a token, if it is there.
    fn position(&self, positions: &JointPositions) -> Option<f64> {
        let position = match &self.mimic {
            Some((other, factor, offset)) => positions.position(other)? * factor + offset,
            None => positions.position(&self.name)?,
        };
        Some(position).filter(|position| position.is_finite())
    }

    fn transform(&self, pose: Pose3) -> Transform {
        Transform { parent: self.parent.clone(), child: self.child.clone(), pose, ..Transform::default() }
    }

    fn moves(&self) -> bool {
        matches!(self.kind, JointKind::Turning(_) | JointKind::Sliding(_))
    }
}

/// Model of a robot: the joints between its links, which are a tree.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Urdf {
    /// Joints, in the order of the file.
    pub joints: Vec<Joint>,
}

impl Urdf {
    /// Reads a model.
    ///
    /// # Errors
    /// The file cannot be read, or is not a model: the place and the reason.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, UrdfError> {
        let path = path.as_ref();
        let error = |place, message| UrdfError { path: path.to_owned(), place, message };
        let text = fs::read_to_string(path).map_err(|e| error(None, e.to_string()))?;
        Self::read(&text).map_err(|(place, message)| error(Some((place.row, place.col)), message))
    }

    /// Transforms of the joints that are fixed.
    pub fn fixed(&self) -> Transforms {
        let fixed = self.joints.iter().filter(|joint| joint.kind == JointKind::Fixed);
        Transforms { transforms: fixed.map(|joint| joint.transform(joint.origin)).take(MAX_TRANSFORMS).collect() }
    }

    /// Transforms of the joints whose positions are known, at the time of the positions.
    pub fn moving(&self, positions: &JointPositions) -> Transforms {
        let mut transforms = Fixed::new();
        for joint in self.joints.iter().filter(|joint| joint.moves()) {
            if let Some(position) = joint.position(positions) {
                let transform = Transform { stamp: positions.stamp, ..joint.transform(joint.pose(position)) };
                // There is room: it was counted.
                let _ = transforms.push(transform);
            }
        }
        Transforms { transforms }
    }

    fn read(text: &str) -> Result<Self, Mistake> {
        let document = Document::parse(text).map_err(|e| (e.pos(), format!("this is not XML: {e}")))?;
        let robot = document.root_element();
        if !robot.has_tag_name("robot") {
            let name = robot.tag_name().name();
            let fix = "a `.xacro` file has to be expanded first";
            return Err(mistake(robot, format!("the root is `<{name}>` and not `<robot>`; {fix}")));
        }
        let mut links = BTreeMap::new();
        for link in children(robot, "link") {
            if links.insert(name(link, "name")?, link).is_some() {
                return Err(mistake(link, format!("there are two links `{}`", name(link, "name")?)));
            }
        }
        let nodes: Vec<Node<'_, '_>> = children(robot, "joint").collect();
        let joints = nodes.iter().map(|node| joint(*node)).collect::<Result<Vec<_>, _>>()?;
        check_count(robot, &joints)?;
        for (at, (joint, node)) in joints.iter().zip(&nodes).enumerate() {
            check(joint, *node, &joints[..at], &joints, &links)?;
        }
        Ok(Self { joints })
    }
}

/// Place and description of a mistake.
type Mistake = (TextPos, String);

fn mistake(node: Node<'_, '_>, message: impl Into<String>) -> Mistake {
    (node.document().text_pos_at(node.range().start), message.into())
}

/// Elements of this name in another one.
fn children<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |child| child.has_tag_name(name))
}

fn attribute<'a>(node: Node<'a, '_>, attribute: &str) -> Result<&'a str, Mistake> {
    let tag = node.tag_name().name();
    node.attribute(attribute).ok_or_else(|| mistake(node, format!("`<{tag}>` has no attribute `{attribute}`")))
}

fn name(node: Node<'_, '_>, of: &str) -> Result<FrameName, Mistake> {
    let text = attribute(node, of)?;
    let name = frame_name(text).map_err(|error| mistake(node, format!("`{text}`: {error}")))?;
    if name.is_empty() { Err(mistake(node, "a name is empty")) } else { Ok(name) }
}

/// Finite number in an attribute, or `default` if it is not there.
fn number(node: Node<'_, '_>, of: &str, default: f64) -> Result<f64, Mistake> {
    node.attribute(of).map_or(Ok(default), |text| parse(node, of, text))
}

fn parse(node: Node<'_, '_>, of: &str, text: &str) -> Result<f64, Mistake> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| mistake(node, format!("`{of}` has `{text}`, which is not a number")))
}

/// Three numbers in an attribute, or `default` if it is not there.
fn three(node: Node<'_, '_>, of: &str, default: [f64; 3]) -> Result<[f64; 3], Mistake> {
    let Some(text) = node.attribute(of) else { return Ok(default) };
    let numbers = text.split_whitespace().map(|word| parse(node, of, word)).collect::<Result<Vec<_>, _>>()?;
    numbers
        .try_into()
        .map_err(|numbers: Vec<f64>| mistake(node, format!("`{of}` has {} numbers, and needs three", numbers.len())))
}

fn joint(node: Node<'_, '_>) -> Result<Joint, Mistake> {
    let link = |tag: &'static str| {
        let element = children(node, tag).next();
        name(element.ok_or_else(|| mistake(node, format!("the joint has no `<{tag}>`")))?, "link")
    };
    let origin = children(node, "origin").next().map_or(Ok(Pose3::default()), |origin| {
        let (xyz, [roll, pitch, yaw]) = (three(origin, "xyz", [0.0; 3])?, three(origin, "rpy", [0.0; 3])?);
        Ok(Pose3::new(xyz, Rotation::from_rpy(roll, pitch, yaw)))
    })?;
    let kind = match attribute(node, "type")? {
        "fixed" => JointKind::Fixed,
        "revolute" | "continuous" => JointKind::Turning(axis(node)?),
        "prismatic" => JointKind::Sliding(axis(node)?),
        "floating" | "planar" => JointKind::Free,
        other => {
            let kinds = "`fixed`, `revolute`, `continuous`, `prismatic`, `floating` or `planar`";
            return Err(mistake(node, format!("a joint cannot be `{other}`, but {kinds}")));
        }
    };
    let mimic = children(node, "mimic")
        .next()
        .map(|mimic| Ok((name(mimic, "joint")?, number(mimic, "multiplier", 1.0)?, number(mimic, "offset", 0.0)?)));
    let (parent, child) = (link("parent")?, link("child")?);
    Ok(Joint { name: name(node, "name")?, parent, child, origin, kind, mimic: mimic.transpose()? })
}

/// Axis of a joint, of length 1: the x axis if the joint does not say it.
fn axis(node: Node<'_, '_>) -> Result<[f64; 3], Mistake> {
    let Some(element) = children(node, "axis").next() else { return Ok([1.0, 0.0, 0.0]) };
    let axis = three(element, "xyz", [1.0, 0.0, 0.0])?;
    let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    if length > 0.0 && length.is_finite() {
        Ok(axis.map(|c| c / length))
    } else {
        Err(mistake(element, "an axis has the length 0 or is too long to compute with: it needs a direction"))
    }
}

/// Checks a joint against its links, those before it and all.
fn check(
    joint: &Joint,
    node: Node<'_, '_>,
    before: &[Joint],
    all: &[Joint],
    links: &BTreeMap<FrameName, Node<'_, '_>>,
) -> Result<(), Mistake> {
    let Joint { name, parent, child, mimic, .. } = joint;
    if let Some(link) = [parent, child].into_iter().find(|link| !links.contains_key(*link)) {
        return Err(mistake(node, format!("the joint `{name}` has the link `{link}`, which is not in the file")));
    }
    if before.iter().any(|other| other.name == *name) {
        return Err(mistake(node, format!("there are two joints `{name}`")));
    }
    if let Some(other) = before.iter().find(|other| other.child == *child) {
        let (first, second) = (&other.name, name);
        return Err(mistake(
            node,
            format!("the link `{child}` has two parents, by the joints `{first}` and `{second}`"),
        ));
    }
    // Those before form no cycle, so that the way up ends.
    let up = |link: &FrameName| before.iter().find(|joint| joint.child == *link).map(|joint| joint.parent.clone());
    if std::iter::successors(Some(parent.clone()), up).any(|link| link == *child) {
        return Err(mistake(
            node,
            format!("the joint `{name}` closes a cycle: the link `{parent}` is below `{child}`"),
        ));
    }
    match mimic {
        Some((other, ..)) if !all.iter().any(|joint| joint.name == *other && joint.mimic.is_none()) => Err(mistake(
            node,
            format!("the joint `{name}` follows `{other}`, which is not a joint that moves by itself"),
        )),
        _ => Ok(()),
    }
}

fn check_count(robot: Node<'_, '_>, joints: &[Joint]) -> Result<(), Mistake> {
    let fixed = joints.iter().filter(|joint| joint.kind == JointKind::Fixed).count();
    let moving = joints.iter().filter(|joint| joint.moves()).count();
    if fixed.max(moving) > MAX_TRANSFORMS {
        let count = format!("it has {fixed} fixed joints and {moving} that move");
        return Err(mistake(robot, format!("{count}, of which {MAX_TRANSFORMS} each fit into a token")));
    }
    Ok(())
}
