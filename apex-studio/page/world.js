// @ts-check
// The plane, and images.
import { ORIGIN, drawAll, moved } from "./drawn.js";

/** @typedef {import("./drawn.js").Pose} Pose */

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

  /** @param {import("./drawn.js").Token[]} tokens */
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
    drawAll(this, tokens, (from, draw) => {
      this.place = from;
      c.save();
      c.translate(from.x, from.y);
      c.rotate(from.theta);
      try {
        draw();
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

  /** @param {Pose} pose @param {number[]} size @param {string} color */
  box(pose, [length, width], color) {
    const corners = [[1, 1], [-1, 1], [-1, -1], [1, -1], [1, 1]];
    const all = corners.map(([x, y]) => moved(pose, [(x * length) / 2, (y * width) / 2]));
    if (all.every((corner) => corner.every(Number.isFinite))) this.line(all, color);
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
