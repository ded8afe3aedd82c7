// @ts-check
// Tokens with a place: scans, poses, paths, maps, clouds and markers, for whatever draws them.
import { Definition } from "./cdr.js";

/** A pose: a position, a rotation as a quaternion, and its angle in the plane.
 * @typedef {{x: number, y: number, z: number, q: number[], theta: number}} Pose */

/** What draws. Points have two coordinates or three; those of a cloud say more by their heights than by one colour.
 * @typedef {{
 *   points(all: number[][], color: string, isCloud?: boolean): void,
 *   line(all: number[][], color: string): void,
 *   arrow(pose: Pose, color: string): void,
 *   box(pose: Pose, size: number[], color: string): void,
 *   grid(origin: Pose, width: number, height: number, size: number, shade: (at: number) => number | null): void,
 * }} Pen */

/** @type {Pose} */
export const ORIGIN = { x: 0, y: 0, z: 0, q: [0, 0, 0, 1], theta: 0 };
const COLORS = ["#1c7ed6", "#e8590c", "#2f9e44", "#ae3ec9", "#c92a2a", "#0c8599", "#e67700", "#5f3dc4"];

/** Types that have a place, and how they are drawn. @type {Record<string, (pen: Pen, message: any, color: string) => void>} */
const DRAWN = {
  "sensor_msgs/msg/LaserScan": (pen, scan, color) => {
    pen.points(scan.ranges.flatMap((/** @type {number} */ range, /** @type {number} */ at) => {
      const angle = scan.angle_min + at * scan.angle_increment;
      const is = Number.isFinite(range) && range >= scan.range_min && range <= scan.range_max;
      return is ? [[range * Math.cos(angle), range * Math.sin(angle)]] : [];
    }), color);
    pen.arrow(ORIGIN, color);
  },
  "geometry_msgs/msg/PoseStamped": (pen, { pose }, color) => pen.arrow(posed(pose), color),
  "geometry_msgs/msg/Pose": (pen, pose, color) => pen.arrow(posed(pose), color),
  "geometry_msgs/msg/PoseWithCovarianceStamped": (pen, { pose }, color) => uncertain(pen, pose, color),
  "nav_msgs/msg/Odometry": (pen, { pose }, color) => uncertain(pen, pose, color),
  "nav_msgs/msg/Path": (pen, { poses }, color) => {
    /** @type {Pose[]} */
    const all = poses.map((/** @type {any} */ { pose }) => posed(pose)).filter((/** @type {Pose} */ { x }) => Number.isFinite(x));
    pen.line(all.map(({ x, y, z }) => [x, y, z]), color);
    if (all.length > 0) pen.arrow(all[all.length - 1], color);
  },
  "sensor_msgs/msg/PointCloud2": (pen, cloud, color) => {
    const offset = (/** @type {string} */ name) => cloud.fields.find((/** @type {any} */ field) => field.name === name && field.datatype === 7)?.offset;
    const places = ["x", "y", "z"].map(offset);
    const count = Math.min(cloud.width * cloud.height, Math.floor(cloud.data.length / cloud.point_step));
    if (places.includes(undefined) || !(count > 0)) return;
    const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
    const all = Array.from({ length: count }, (_, at) => places.map((place) => view.getFloat32(at * cloud.point_step + place, !cloud.is_bigendian)));
    pen.points(all.filter((point) => point.every(Number.isFinite)), color, true);
  },
  "nav_msgs/msg/OccupancyGrid": (pen, { info, data }) => {
    const shade = (/** @type {number} */ at) => (data[at] < 0 ? null : 255 - 2.2 * data[at]);
    pen.grid(posed(info.origin), info.width, info.height, info.resolution, shade);
  },
  "foxglove_msgs/msg/Grid": (pen, grid) => {
    const values = new DataView(grid.data.buffer, grid.data.byteOffset, grid.data.byteLength);
    const [width, height] = [grid.column_count, grid.row_stride === 0 ? 0 : grid.data.length / grid.row_stride];
    const number = (/** @type {number} */ at) => values.getFloat32(at * grid.cell_stride, true);
    const all = Array.from({ length: width * height }, (_, at) => number(at)).filter(Number.isFinite);
    const [low, high] = all.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
    pen.grid(posed(grid.pose), width, height, grid.cell_size.x, (at) => {
      const value = number(at);
      return Number.isFinite(value) ? 255 - (205 * (value - low)) / (high - low || 1) : null;
    });
  },
  "visualization_msgs/msg/Marker": (pen, marker) => drawMarker(pen, marker),
  "visualization_msgs/msg/MarkerArray": (pen, { markers }) => markers.forEach((/** @type {any} */ marker) => drawMarker(pen, marker)),
};

/** Points of an ellipse. */
const CORNERS = 48;

/** Draws a pose, and the ellipse of two standard deviations of its position. @param {Pen} pen @param {any} estimate @param {string} color */
function uncertain(pen, { pose, covariance }, color) {
  const own = posed(pose);
  pen.arrow(own, color);
  // A root of the covariance (Cholesky) makes the ellipse of a circle.
  const [xx, xy, yy] = [covariance[0], covariance[1], covariance[7]];
  const a = Math.sqrt(xx);
  const b = a > 0 ? xy / a : 0;
  const c = Math.sqrt(Math.max(0, yy - b * b));
  if (!(a > 0 || c > 0)) return;
  pen.line(Array.from({ length: CORNERS + 1 }, (_, at) => {
    const angle = (2 * Math.PI * at) / CORNERS;
    return [own.x + 2 * a * Math.cos(angle), own.y + 2 * (b * Math.cos(angle) + c * Math.sin(angle)), own.z];
  }), color);
}

/** Draws a marker. Bodies are boxes of their size. @param {Pen} pen @param {any} marker */
function drawMarker(pen, { type, action, pose, scale, color, points }) {
  const ADD = 0;
  if (action !== ADD) return;
  const [red, green, blue] = [color.r, color.g, color.b].map((part) => Math.round(255 * Math.min(1, Math.max(0, part || 0))));
  const paint = `#${((red << 16) | (green << 8) | blue).toString(16).padStart(6, "0")}`;
  const own = posed(pose);
  /** @type {number[][]} */
  const all = points.map((/** @type {any} */ { x, y, z }) => moved(own, [x, y, z])).filter((/** @type {number[]} */ point) => point.every(Number.isFinite));
  const [ARROW, CUBE, CYLINDER, LINE_STRIP, LINE_LIST, POINTS] = [0, 1, 3, 4, 5, 8];
  if (type === ARROW && all.length < 2) pen.arrow(own, paint);
  else if (type >= CUBE && type <= CYLINDER) pen.box(own, [scale.x, scale.y, scale.z], paint);
  else if (type === LINE_LIST) for (let at = 0; at + 1 < all.length; at += 2) pen.line(all.slice(at, at + 2), paint);
  else if (type === LINE_STRIP || type === ARROW) pen.line(all, paint);
  else if (type <= POINTS) pen.points(all, paint);
}

/** @param {any} pose @returns {Pose} */
const posed = ({ position, orientation: { x, y, z, w } }) => ({ x: position.x, y: position.y, z: position.z, q: [x, y, z, w], theta: 2 * Math.atan2(z, w) });

/** A point in the frame in which a pose is. @param {Pose} pose @param {number[]} point @returns {number[]} */
export function moved({ x, y, z, q: [a, b, c, w] }, [px, py, pz = 0]) {
  const [tx, ty, tz] = [2 * (b * pz - c * py), 2 * (c * px - a * pz), 2 * (a * py - b * px)];
  return [x + px + w * tx + b * tz - c * ty, y + py + w * ty + c * tx - a * tz, z + pz + w * tz + a * ty - b * tx];
}

/** `true` if tokens of a type have a place. @param {string} schema */
export const hasPlace = (schema) => schema in DRAWN;

/** `true` if tokens of a type are measured from where the robot is. @param {string} schema */
export const isMeasured = (schema) => ["sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"].includes(schema);

/** `true` if tokens of a type can give others their place. @param {string} schema */
export const isPose = (schema) => /^geometry_msgs\/msg\/Pose(WithCovariance)?(Stamped)?$/.test(schema) || schema === "nav_msgs/msg/Odometry";

/** The pose in a message for which that is true. @param {any} message @returns {any} */
const poseIn = (message) => message.pose?.pose ?? message.pose ?? message;

/** A token with a place, which may be seen from a pose. @typedef {{schema: string, message: any, from: any}} Token */

/** Draws tokens; `seen` is told from where each is seen before it is drawn. @param {Pen} pen @param {Token[]} tokens @param {(from: Pose, draw: () => void) => void} seen */
export function drawAll(pen, tokens, seen) {
  tokens.forEach(({ schema, message, from }, at) => {
    seen(from ? posed(poseIn(from)) : ORIGIN, () => DRAWN[schema](pen, message, COLORS[at % COLORS.length]));
  });
}

/** Definitions, read once. @type {Map<string, Definition>} */
const definitions = new Map();

/** Reads a token. @param {string} definition @param {Uint8Array} bytes @returns {any} */
export function read(definition, bytes) {
  let known = definitions.get(definition);
  if (!known) definitions.set(definition, (known = new Definition(definition)));
  return known.read(bytes);
}
