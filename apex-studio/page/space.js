// @ts-check
// Tokens with a place, drawn together in space, as seen by an eye that the mouse moves.
import { ORIGIN, drawAll, moved } from "./drawn.js";

/** @typedef {import("./drawn.js").Pose} Pose */

const ATTRIBUTES = ["at", "paint"];
const VERTEX = `attribute vec3 at; attribute vec3 paint; uniform mat4 seen; uniform float size; varying vec3 color;
void main() { gl_Position = seen * vec4(at, 1.0); gl_PointSize = size; color = paint; }`;
const FRAGMENT = "precision mediump float; varying vec3 color; void main() { gl_FragColor = vec4(color, 1.0); }";

/** Opening of the eye, in rad. */
const OPENING = 0.9;
const UPRIGHT = Math.PI / 2 - 0.01;
/** Lines of the floor at most, in each direction. */
const MAX_LINES = 40;
/** Points from which it is computed what is to be seen. */
const MAX_SAMPLES = 3000;

/** Vertices of one kind: their coordinates and colours, three numbers each. */
class Vertices {
  constructor() {
    /** @type {number[]} */ this.at = [];
    /** @type {number[]} */ this.paint = [];
  }

  /** @param {number[]} at @param {number[]} paint */
  add(at, paint) {
    this.at.push(at[0], at[1], at[2]);
    this.paint.push(paint[0], paint[1], paint[2]);
  }
}

/** Space: x forward, y to the left, z up. */
export class Space {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    /** The eye looks at `middle` from this distance; in rad: the direction to it, and its height. */
    this.eye = { middle: [0, 0, 0], distance: 10, turn: -2.4, height: 0.6 };
    /** `true` if somebody has moved the eye: it then stays where it is. */
    this.isMoved = false;
    this.place = ORIGIN;
    this.all = new Vertices();
    this.lines = new Vertices();
    this.faces = new Vertices();
    /** Points that were drawn. @type {number[][]} */ this.covered = [];
    this.listen();
    /** What draws, once it was needed; `null` if the browser cannot. @type {Painter | null | undefined} */ this.painter = undefined;
  }

  /** @param {import("./drawn.js").Token[]} tokens */
  draw(tokens) {
    this.all = new Vertices();
    this.lines = new Vertices();
    this.faces = new Vertices();
    this.covered = [];
    drawAll(this, tokens, (from, draw) => {
      this.place = from;
      draw();
    });
    if (!this.isMoved) this.look();
    this.floor();
    this.show();
  }

  /** Lets the eye see nearly all that was drawn, if it has changed much: what comes from far away does not count. */
  look() {
    const step = Math.ceil(this.covered.length / MAX_SAMPLES);
    const some = this.covered.filter((_, at) => at % step === 0);
    if (some.length === 0) return;
    const ranges = [0, 1, 2].map((axis) => {
      const sorted = some.map((point) => point[axis]).sort((a, b) => a - b);
      const [low, high] = [0.05, 0.95].map((share) => sorted[Math.round(share * (sorted.length - 1))]);
      return { middle: (low + high) / 2, size: high - low };
    });
    const distance = (0.6 * Math.hypot(...ranges.map(({ size }) => size)) + 1) / Math.tan(OPENING / 2);
    const middle = ranges.map((range) => range.middle);
    const { eye } = this;
    const isElsewhere = Math.hypot(...middle.map((at, axis) => at - eye.middle[axis])) > eye.distance / 6;
    if (isElsewhere || distance > 1.3 * eye.distance || distance < 0.6 * eye.distance) Object.assign(eye, { middle, distance });
  }

  /** @param {number[]} point @returns {number[] | null} */
  covers(point) {
    const at = moved(this.place, point);
    if (!at.every(Number.isFinite)) return null;
    this.covered.push(at);
    return at;
  }

  /** The points of a cloud have the colours of their heights. @param {number[][]} all @param {string} color @param {boolean} isCloud */
  points(all, color, isCloud = false) {
    const [heights, plain] = [isCloud ? all.map((point) => point[2]).sort((a, b) => a - b) : [], parts(color)];
    const [low, high] = [0.02, 0.98].map((share) => heights[Math.round(share * (heights.length - 1))]);
    for (const point of all) {
      const at = this.covers(point);
      if (at) this.all.add(at, isCloud ? rainbow((point[2] - low) / (high - low || 1)) : plain);
    }
  }

  /** @param {number[][]} all @param {string} color */
  line(all, color) {
    const [seen, paint] = [all.flatMap((point) => { const at = this.covers(point); return at ? [at] : []; }), parts(color)];
    for (let at = 1; at < seen.length; at += 1) this.edge(seen[at - 1], seen[at], paint);
  }

  /** @param {number[]} from @param {number[]} to @param {number[]} paint */
  edge(from, to, paint) {
    this.lines.add(from, paint);
    this.lines.add(to, paint);
  }

  /** @param {Pose} pose @param {string} color */
  arrow(pose, color) {
    const size = this.eye.distance / 40;
    const [tip, left, back, right] = [[1.4, 0], [-0.7, 0.7], [-0.3, 0], [-0.7, -0.7]].map(([x, y]) => this.covers(moved(pose, [x * size, y * size])));
    if (tip && left && back && right) for (const corner of [tip, left, back, tip, back, right]) this.faces.add(corner, parts(color));
  }

  /** @param {Pose} pose @param {number[]} size @param {string} color */
  box(pose, size, color) {
    const corner = (/** @type {number} */ number) => this.covers(moved(pose, size.map((length, axis) => ((number >> axis) & 1 ? length : -length) / 2)));
    const corners = Array.from({ length: 8 }, (_, number) => corner(number));
    corners.forEach((from, number) => {
      for (const axis of [1, 2, 4]) {
        const to = corners[number | axis];
        if (from && to && !(number & axis)) this.edge(from, to, parts(color));
      }
    });
  }

  /** Cells of one shade beside one another are one face. @param {Pose} origin @param {number} width @param {number} height @param {number} size @param {(at: number) => number | null} shade */
  grid(origin, width, height, size, shade) {
    if (!(width * height > 0 && width * height <= 4e6)) return;
    for (let row = 0; row < height; row += 1) {
      for (let begin = 0, end = 0; begin < width; begin = end) {
        const value = shade(row * width + begin);
        for (end = begin + 1; end < width && shade(row * width + end) === value; ) end += 1;
        if (value === null) continue;
        const corners = [[begin, row], [end, row], [end, row + 1], [begin, row + 1]].map(([x, y]) => this.covers(moved(origin, [x * size, y * size])));
        const paint = [value / 255, value / 255, value / 255];
        for (const at of [0, 1, 2, 0, 2, 3]) {
          const corner = corners[at];
          if (corner) this.faces.add(corner, paint);
        }
      }
    }
  }

  /** Lines of the floor, a round number of m apart, and the axes at the origin: red, green, blue. */
  floor() {
    const { middle, distance } = this.eye;
    const wide = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].find((step) => (2 * distance) / step <= MAX_LINES) ?? 2000;
    const reach = Math.ceil(distance / wide) * wide;
    const [x0, y0] = [middle[0], middle[1]].map((at) => Math.round(at / wide) * wide);
    for (let at = -reach; at <= reach; at += wide) {
      this.edge([x0 + at, y0 - reach, 0], [x0 + at, y0 + reach, 0], [0.5, 0.5, 0.5]);
      this.edge([x0 - reach, y0 + at, 0], [x0 + reach, y0 + at, 0], [0.5, 0.5, 0.5]);
    }
    for (const axis of [[1, 0, 0], [0, 1, 0], [0, 0, 1]]) this.edge([0, 0, 0], axis, axis);
  }

  /** Shows what was drawn as the eye sees it now. */
  show() {
    const { canvas } = this;
    if (this.painter === undefined) this.painter = painter(canvas);
    canvas.dataset.can = String(this.painter !== null);
    if (!this.painter) return;
    const { gl, program, buffers } = this.painter;
    [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight].map((size) => Math.max(1, Math.round(size * devicePixelRatio)));
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(gl.getUniformLocation(program, "seen"), false, seen(this.eye, canvas.width / canvas.height));
    gl.uniform1f(gl.getUniformLocation(program, "size"), 2.5 * devicePixelRatio);
    for (const [kind, { at, paint }] of /** @type {[number, Vertices][]} */ ([[gl.TRIANGLES, this.faces], [gl.LINES, this.lines], [gl.POINTS, this.all]])) {
      [at, paint].forEach((numbers, place) => {
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers[place]);
        gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.STREAM_DRAW);
        gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
      });
      gl.drawArrays(kind, 0, at.length / 3);
    }
  }

  /** The mouse moves the eye: it turns, with Shift or another button it goes along, the wheel brings it nearer. */
  listen() {
    const { canvas, eye } = this;
    const change = (/** @type {() => void} */ by) => {
      this.isMoved = true;
      by();
      this.show();
    };
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointermove", ({ buttons, shiftKey, movementX: x, movementY: y }) => {
      if (buttons === 0) return;
      change(() => {
        if (buttons === 1 && !shiftKey) {
          eye.turn -= x * 0.01;
          eye.height = Math.min(UPRIGHT, Math.max(-UPRIGHT, eye.height + y * 0.01));
        } else {
          const scale = (2 * eye.distance * Math.tan(OPENING / 2)) / canvas.clientHeight;
          const [cos, sin] = [Math.cos(eye.turn), Math.sin(eye.turn)];
          eye.middle[0] += scale * (x * sin - y * cos);
          eye.middle[1] -= scale * (x * cos + y * sin);
        }
      });
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      change(() => (eye.distance = Math.min(1e4, Math.max(0.1, eye.distance * Math.exp(event.deltaY * 0.001)))));
    }, { passive: false });
    canvas.addEventListener("dblclick", () => {
      this.isMoved = false;
      this.look();
      this.show();
    });
  }
}

/** @typedef {{gl: WebGLRenderingContext, program: WebGLProgram, buffers: (WebGLBuffer | null)[]}} Painter */

/** What draws on a canvas. @param {HTMLCanvasElement} canvas @returns {Painter | null} */
function painter(canvas) {
  const gl = canvas.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
  const program = gl?.createProgram();
  if (!gl || !program) return null;
  for (const [kind, text] of /** @type {[number, string][]} */ ([[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]])) {
    const shader = gl.createShader(kind);
    if (!shader) return null;
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  ATTRIBUTES.forEach((name, place) => {
    gl.bindAttribLocation(program, place, name);
    gl.enableVertexAttribArray(place);
  });
  gl.linkProgram(program);
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  gl.clearColor(0, 0, 0, 0);
  return { gl, program, buffers: ATTRIBUTES.map(() => gl.createBuffer()) };
}

/** Matrix from space to the screen, column by column. @param {Space["eye"]} eye @param {number} aspect */
function seen({ middle, distance, turn, height }, aspect) {
  const [cos, sin, up, flat] = [Math.cos(turn), Math.sin(turn), Math.sin(height), Math.cos(height)];
  // The axes of the eye: to the right, up, and backward.
  const axes = [[-sin, cos, 0], [-up * cos, -up * sin, flat], [flat * cos, flat * sin, up]];
  const at = axes[2].map((part, axis) => middle[axis] + distance * part);
  const moves = axes.map((axis) => -axis.reduce((sum, part, i) => sum + part * at[i], 0));
  const [near, far, zoom] = [distance / 100, distance * 100, 1 / Math.tan(OPENING / 2)];
  const [scale, shift] = [(near + far) / (near - far), (2 * near * far) / (near - far)];
  const [right, above, back] = axes;
  const column = (/** @type {number} */ i) => [(zoom / aspect) * right[i], zoom * above[i], scale * back[i], -back[i]];
  return [...column(0), ...column(1), ...column(2), (zoom / aspect) * moves[0], zoom * moves[1], scale * moves[2] + shift, -moves[2]];
}

/** Red, green and blue of a colour, from 0 to 1. @param {string} color */
const parts = (color) => [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16) / 255);

/** From blue for 0 over green to red for 1. @param {number} share */
function rainbow(share) {
  const hue = 4 * (1 - Math.min(1, Math.max(0, share)));
  return [Math.abs(hue - 3) - 1, 2 - Math.abs(hue - 2), 2 - Math.abs(hue - 4)].map((part) => 0.85 * Math.min(1, Math.max(0, part)));
}
