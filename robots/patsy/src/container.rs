//! Dimensions of the containers.

use apex_nodes::scan::Point2;

// The thesis gives no dimensions. These are those of a common hospital transport cart for about 1.2 m × 0.7 m of
// goods, on four castors with wheels of 125 mm.

/// Distance across between the outer sides of the wheels, in m.
pub const WIDTH: f32 = 0.68;
/// Distance lengthwise between the outer sides of the wheels, in m.
pub const LENGTH: f32 = 1.2;
/// Width of a wheel, in m.
pub const WHEEL_WIDTH: f32 = 0.04;
/// Length of a wheel at the height of the scanner, in m.
pub const WHEEL_LENGTH: f32 = 0.125;
/// Distance from the pivot of a castor to the axle of its wheel, in m.
pub const TRAIL: f32 = 0.04;

/// Height of the body of the cart above the floor, in m.
pub const BODY: f32 = 0.22;
/// Height of the top of the cart, in m.
pub const TOP: f32 = 1.3;

/// Positions of the pivots relative to the centre: ±x along, ±y across.
const PIVOT: Point2 = Point2::new(0.5 * (LENGTH - WHEEL_LENGTH), 0.5 * (WIDTH - WHEEL_WIDTH));
/// Side of a wheel box, in m. A wheel stays within 10.5 cm of its pivot; the rest is for noise and the error of the
/// pose.
const BOX: f32 = 0.25;

/// Box model of the cart: rows of x, y, length, width of the area that a castor can reach, in m, in the frame of the
/// cart.
pub const WHEEL_BOXES: &[[f32; 4]] = &[
    [-PIVOT.x, -PIVOT.y, BOX, BOX],
    [-PIVOT.x, PIVOT.y, BOX, BOX],
    [PIVOT.x, -PIVOT.y, BOX, BOX],
    [PIVOT.x, PIVOT.y, BOX, BOX],
];
