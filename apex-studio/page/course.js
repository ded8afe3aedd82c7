// @ts-check
// The course of a study: the best value after each candidate, for each search.
import { cleared, colors, marks, tip } from "./page.js";
import { number, search, study } from "./study.js";

const LEFT = 62;
const BOTTOM = 20;
const TOP = 10;
const RIGHT = 10;
/** Ratio of the values from which on their scale is logarithmic. */
const WIDE = 100;

export class Course {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    canvas.addEventListener("pointermove", (event) => tip(this.words(event), event));
    canvas.addEventListener("pointerleave", () => tip(null));
    addEventListener("resize", () => this.draw());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  /** Value of the defaults in the diagram: with several goals it shows changes from them. */
  defaults() {
    return (study.about?.goals.length ?? 1) > 1 ? 0 : study.state?.defaults?.[0] ?? null;
  }

  /** Ranges of the values, with a margin. @returns {{low: number, high: number, wide: boolean} | null} */
  range() {
    const all = (study.state?.searches ?? []).flatMap(({ improvements }) => improvements.map(([, value]) => value));
    const defaults = this.defaults();
    if (defaults !== null) all.push(defaults);
    if (all.length === 0) return null;
    const [low, high] = all.reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);
    if (low > 0 && high / low >= WIDE) return { low: low / 1.2, high: high * 1.2, wide: true };
    const margin = 0.05 * (high - low || Math.abs(high) || 1);
    return { low: low - margin, high: high + margin, wide: false };
  }

  /** @param {number} count */
  x(count) {
    return LEFT + (count / Math.max(1, study.about?.candidates ?? 1)) * (this.canvas.clientWidth - LEFT - RIGHT);
  }

  draw() {
    const { canvas } = this;
    const [width, height] = [canvas.clientWidth, canvas.parentElement ? Math.round(Math.min(220, canvas.parentElement.clientHeight * 0.3)) : 0];
    const c = cleared(canvas, width, height);
    // What is drawn, for tests.
    canvas.dataset.course = (search()?.improvements ?? []).map(([count, value]) => `${count}:${number(value)}`).join(" ");
    const range = this.range();
    if (!c || !range) return;
    const { low, high, wide } = range;
    const share = (/** @type {number} */ value) => (wide ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
    const y = (/** @type {number} */ value) => height - BOTTOM - share(value) * (height - BOTTOM - TOP);
    const color = colors();
    this.axes(c, color, y, range, height);
    const defaults = this.defaults();
    if (defaults !== null) this.dashed(c, color("--soft"), y(defaults));
    for (const { number, improvements } of study.state?.searches ?? []) {
      const isShown = number === study.search;
      c.strokeStyle = color(isShown ? "--fire" : "--soft");
      c.globalAlpha = isShown ? 1 : 0.4;
      c.lineWidth = isShown ? 2 : 1;
      this.steps(c, y, improvements, this.end(number));
    }
    c.globalAlpha = 1;
    if (study.selected !== null) {
      c.fillStyle = color("--accent");
      c.fillRect(this.x(study.selected), TOP, 1.5, height - BOTTOM - TOP);
    }
  }

  /** Number of candidates of a search so far. @param {number} number */
  end(number) { return study.state?.searches.find((search) => search.number === number)?.ended ?? 0; }

  /** A line that is constant between improvements. @param {CanvasRenderingContext2D} c @param {(value: number) => number} y @param {[number, number][]} improvements @param {number} end */
  steps(c, y, improvements, end) {
    c.beginPath();
    improvements.forEach(([count, value], at) => {
      c.lineTo(this.x(count), y(value));
      c.lineTo(this.x(improvements[at + 1]?.[0] ?? end), y(value));
    });
    c.stroke();
  }

  /** @param {CanvasRenderingContext2D} c @param {string} color @param {number} y */
  dashed(c, color, y) {
    c.strokeStyle = color;
    c.lineWidth = 1;
    c.setLineDash([4, 4]);
    c.beginPath();
    c.moveTo(LEFT, y);
    c.lineTo(this.canvas.clientWidth - RIGHT, y);
    c.stroke();
    c.setLineDash([]);
    c.fillStyle = color;
    c.textAlign = "right";
    // Above the line, or below it if there is no room.
    c.fillText("defaults", this.canvas.clientWidth - RIGHT - 4, y > TOP + 14 ? y - 8 : y + 9);
    c.textAlign = "left";
  }

  /** @param {CanvasRenderingContext2D} c @param {(name: string) => string} color @param {(value: number) => number} y @param {{low: number, high: number, wide: boolean}} range @param {number} height */
  axes(c, color, y, { low, high, wide }, height) {
    const values = wide ? powers(low, high) : marks(low, high, 4)[0];
    c.fillStyle = color("--soft");
    c.textAlign = "right";
    for (const value of values) c.fillText(number(value), LEFT - 6, y(value));
    c.textAlign = "left";
    for (const count of marks(0, study.about?.candidates ?? 1, this.canvas.clientWidth / 110)[0]) {
      if (!Number.isInteger(count)) continue;
      if (this.x(count) < this.canvas.clientWidth - 40) c.fillText(String(count), this.x(count) + 3, height - BOTTOM / 2);
      c.globalAlpha = 0.3;
      c.fillRect(this.x(count), TOP, 1, height - BOTTOM - TOP);
      c.globalAlpha = 1;
    }
    c.globalAlpha = 0.3;
    for (const value of values) c.fillRect(LEFT, y(value), this.canvas.clientWidth - LEFT - RIGHT, 1);
    c.globalAlpha = 1;
  }

  /** The best value after the candidates at the pointer. @param {MouseEvent} event */
  words(event) {
    const share = (event.offsetX - LEFT) / (this.canvas.clientWidth - LEFT - RIGHT);
    const count = Math.round(share * (study.about?.candidates ?? 0));
    const last = (search()?.improvements ?? []).filter(([at]) => at <= count).at(-1);
    if (!last || count > this.end(study.search)) return null;
    return `after ${count} candidates: ${this.value(last[1])}`;
  }

  /** A value of the diagram in words. @param {number} value */
  value(value) {
    const goals = study.about?.goals ?? [];
    return goals.length > 1 ? `${(100 * value).toFixed(2)} % against the defaults` : number(value, goals[0]?.unit);
  }
}

/** Powers of ten in a range. @param {number} low @param {number} high */
function powers(low, high) {
  const [first, last] = [Math.ceil(Math.log10(low)), Math.floor(Math.log10(high))];
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, at) => 10 ** (first + at));
}
