// @ts-check
// Tokens with a place in the plane, drawn together: scans, poses, paths, maps; and images.
import { Definition } from "./cdr.js";

/** @typedef {{x: number, y: number, theta: number}} Pose */

const ORIGIN = { x: 0, y: 0, theta: 0 };
const COLORS = ["#1c7ed6", "#e8590c", "#2f9e44", "#ae3ec9", "#c92a2a", "#0c8599", "#e67700", "#5f3dc4"];

/** Types that have a place, and how they are drawn. @type {Record<string, (c: World, message: any, color: string) => void>} */
const DRAWN = {
  "sensor_msgs/msg/LaserScan": (world, scan, color) => {
    world.points(scan.ranges.flatMap((/** @type {number} */ range, /** @type {number} */ at) => {
      const angle = scan.angle_min + at * scan.angle_increment;
      const is = Number.isFinite(range) && range >= scan.range_min && range <= scan.range_max;
      return is ? [[range * Math.cos(angle), range * Math.sin(angle)]] : [];
    }), color);
    world.arrow(ORIGIN, color);
  },
  "geometry_msgs/msg/PoseStamped": (world, { pose }, color) => world.arrow(planar(pose), color),
  "geometry_msgs/msg/Pose": (world, pose, color) => world.arrow(planar(pose), color),
  "nav_msgs/msg/Path": (world, { poses }, color) => {
    /** @type {Pose[]} */
    const all = poses.map((/** @type {any} */ { pose }) => planar(pose)).filter((/** @type {Pose} */ { x }) => Number.isFinite(x));
    world.line(all.map(({ x, y }) => [x, y]), color);
    if (all.length > 0) world.arrow(all[all.length - 1], color);
  },
  "sensor_msgs/msg/PointCloud2": (world, cloud, color) => {
    const offset = (/** @type {string} */ name) => cloud.fields.find((/** @type {any} */ field) => field.name === name && field.datatype === 7)?.offset;
    const [x, y] = [offset("x"), offset("y")];
    const count = Math.min(cloud.width * cloud.height, Math.floor(cloud.data.length / cloud.point_step));
    if (x === undefined || y === undefined || !(count > 0)) return;
    const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
    const all = Array.from({ length: count }, (_, at) => [x, y].map((place) => view.getFloat32(at * cloud.point_step + place, !cloud.is_bigendian)));
    world.points(all.filter(([a, b]) => Number.isFinite(a) && Number.isFinite(b)), color);
  },
  "nav_msgs/msg/OccupancyGrid": (world, { info, data }) => {
    const shade = (/** @type {number} */ at) => (data[at] < 0 ? null : 255 - 2.2 * data[at]);
    world.grid(planar(info.origin), info.width, info.height, info.resolution, shade);
  },
  "foxglove_msgs/msg/Grid": (world, grid) => {
    const values = new DataView(grid.data.buffer, grid.data.byteOffset, grid.data.byteLength);
    const [width, height] = [grid.column_count, grid.row_stride === 0 ? 0 : grid.data.length / grid.row_stride];
    const number = (/** @type {number} */ at) => values.getFloat32(at * grid.cell_stride, true);
    const all = Array.from({ length: width * height }, (_, at) => number(at)).filter(Number.isFinite);
    const [low, high] = all.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
    world.grid(planar(grid.pose), width, height, grid.cell_size.x, (at) => {
      const value = number(at);
      return Number.isFinite(value) ? 255 - (205 * (value - low)) / (high - low || 1) : null;
    });
  },
};

/** @param {any} pose @returns {Pose} */
const planar = ({ position, orientation: { z, w } }) => ({ x: position.x, y: position.y, theta: 2 * Math.atan2(z, w) });

/** `true` if tokens of a type have a place. @param {string} schema */
export const hasPlace = (schema) => schema in DRAWN;

/** `true` if tokens of a type are measured from where the robot is. @param {string} schema */
export const isMeasured = (schema) => ["sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"].includes(schema);

/** `true` if tokens of a type can give others their place. @param {string} schema */
export const isPose = (schema) => schema.startsWith("geometry_msgs/msg/Pose");

/** Definitions, read once. @type {Map<string, Definition>} */
const definitions = new Map();

/** Reads a token. @param {string} definition @param {Uint8Array} bytes @returns {any} */
export function read(definition, bytes) {
  let known = definitions.get(definition);
  if (!known) definitions.set(definition, (known = new Definition(definition)));
  return known.read(bytes);
}

/** The plane, in which all tokens with a place are drawn: x to the right, y up. */
export class World {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.c = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    /** Bounds of what was drawn, in m. */
    this.bounds = [Infinity, Infinity, -Infinity, -Infinity];
    this.scale = 20;
    this.middle = [0, 0];
    this.place = ORIGIN;
  }

  /** Draws tokens; each may be seen from a pose. @param {{schema: string, message: any, from: any}[]} tokens */
  draw(tokens) {
    const { canvas, c } = this;
    const ratio = devicePixelRatio;
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = canvas.clientHeight * ratio;
    const [x0, y0, x1, y1] = this.bounds;
    if (x0 <= x1) {
      const wide = Math.min(canvas.clientWidth / (x1 - x0 + 1), canvas.clientHeight / (y1 - y0 + 1));
      this.scale = Math.min(wide, 200);
      this.middle = [(x0 + x1) / 2, (y0 + y1) / 2];
    }
    this.bounds = [Infinity, Infinity, -Infinity, -Infinity];
    c.setTransform(this.scale * ratio, 0, 0, -this.scale * ratio, canvas.width / 2 - this.middle[0] * this.scale * ratio, canvas.height / 2 + this.middle[1] * this.scale * ratio);
    tokens.forEach(({ schema, message, from }, at) => {
      this.place = from ? planar(from.pose ?? from) : ORIGIN;
      c.save();
      c.translate(this.place.x, this.place.y);
      c.rotate(this.place.theta);
      try {
        DRAWN[schema](this, message, COLORS[at % COLORS.length]);
      } finally {
        c.restore();
      }
    });
  }

  /** Notes that a point was drawn. @param {number} x @param {number} y */
  covers(x, y) {
    const { x: px, y: py, theta } = this.place;
    const [wx, wy] = [px + x * Math.cos(theta) - y * Math.sin(theta), py + x * Math.sin(theta) + y * Math.cos(theta)];
    if (!Number.isFinite(wx) || !Number.isFinite(wy)) return;
    const [x0, y0, x1, y1] = this.bounds;
    this.bounds = [Math.min(x0, wx), Math.min(y0, wy), Math.max(x1, wx), Math.max(y1, wy)];
  }

  /** @param {number[][]} all @param {string} color */
  points(all, color) {
    this.c.fillStyle = color;
    const size = 2.5 / this.scale;
    for (const [x, y] of all) {
      this.covers(x, y);
      this.c.fillRect(x - size / 2, y - size / 2, size, size);
    }
  }

  /** @param {number[][]} all @param {string} color */
  line(all, color) {
    this.c.strokeStyle = color;
    this.c.lineWidth = 2 / this.scale;
    this.c.beginPath();
    for (const [x, y] of all) {
      this.covers(x, y);
      this.c.lineTo(x, y);
    }
    this.c.stroke();
  }

  /** @param {Pose} pose @param {string} color */
  arrow({ x, y, theta }, color) {
    const { c } = this;
    if (!Number.isFinite(x) || !Number.isFinite(y) || !Number.isFinite(theta)) return;
    this.covers(x, y);
    c.save();
    c.translate(x, y);
    c.rotate(theta);
    c.fillStyle = color;
    const size = 9 / this.scale;
    c.beginPath();
    for (const [dx, dy] of [[1.4, 0], [-0.7, 0.7], [-0.3, 0], [-0.7, -0.7]]) c.lineTo(dx * size, dy * size);
    c.fill();
    c.restore();
  }

  /** @param {Pose} origin @param {number} width @param {number} height @param {number} size @param {(at: number) => number | null} shade */
  grid(origin, width, height, size, shade) {
    if (!(width * height > 0 && width * height <= 4e6)) return;
    const image = new ImageData(width, height);
    for (let at = 0; at < width * height; at += 1) {
      const value = shade(at);
      if (value !== null) image.data.set([value, value, value, 255], at * 4);
    }
    const { c } = this;
    c.save();
    c.translate(origin.x, origin.y);
    c.rotate(origin.theta);
    c.imageSmoothingEnabled = false;
    const small = new OffscreenCanvas(width, height);
    small.getContext("2d")?.putImageData(image, 0, 0);
    c.drawImage(small, 0, 0, width * size, height * size);
    c.restore();
    const [cos, sin] = [Math.cos(origin.theta), Math.sin(origin.theta)];
    for (const [x, y] of [[0, 0], [width * size, 0], [0, height * size], [width * size, height * size]]) {
      this.covers(origin.x + x * cos - y * sin, origin.y + x * sin + y * cos);
    }
  }
}

/** Draws an image message. @param {HTMLCanvasElement} canvas @param {any} message */
export function drawImage(canvas, { width, height, encoding, data }) {
  const channels = { mono8: 1, rgb8: 3 }[/** @type {string} */ (encoding)];
  if (!channels || data.length !== width * height * channels || width * height === 0) return;
  const image = new ImageData(width, height);
  for (let at = 0; at < width * height; at += 1) {
    const [r, g, b] = channels === 1 ? [data[at], data[at], data[at]] : data.subarray(3 * at, 3 * at + 3);
    image.data.set([r, g, b, 255], 4 * at);
  }
  canvas.width = width;
  canvas.height = height;
  canvas.style.height = "auto";
  canvas.getContext("2d")?.putImageData(image, 0, 0);
}
