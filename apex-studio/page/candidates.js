// @ts-check
// The candidates of a search as lanes: a mark for each run, by number of the seed, coloured by its value.
import { ask, cleared, colors, element, tip } from "./page.js";
import { hover, number, search, select, study } from "./study.js";

const HEIGHT = 18;
const LABELS = 170;
/** Number of shades between the colours of good and bad values. */
const SHADES = 32;

export class Candidates {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.place = element("lanes");
    this.below = element("lanes-below");
    this.isFollowing = true;
    this.isBestFirst = false;
    /** The last answer. @type {{search: number, first: number, count: number, goal: number, lanes: import("./study.js").Lane[]} | null} */
    this.lanes = null;
    /** Timer of the next request. */
    this.stale = 0;
    this.listen();
  }

  begin() {
    this.lanes = null;
    this.request();
    this.draw();
  }

  /** Number of lanes. */
  count() { return search()?.known ?? 0; }

  /** The study has new runs. */
  grow() {
    this.draw();
    if (this.isFollowing) this.place.scrollTop = this.isBestFirst ? 0 : this.place.scrollHeight;
    this.request();
  }

  /** Asks for what is to be seen, not more often than can be drawn. */
  request() {
    if (this.stale !== 0) return;
    this.stale = setTimeout(() => {
      this.stale = 0;
      const [first, end] = this.rows();
      const about = { search: study.search, goal: study.goal, best: this.isBestFirst };
      ask({ lanes: { ...about, first: Math.max(0, first - 5), count: end - first + 10, columns: Math.max(1, this.width()) } });
    }, 50);
  }

  /** Numbers of the first lane in view, and of the one after the last. @returns {[number, number]} */
  rows() {
    const { scrollTop, clientHeight } = this.place;
    return [Math.floor(scrollTop / HEIGHT), Math.ceil((scrollTop + clientHeight) / HEIGHT)];
  }

  width() { return Math.round(this.canvas.clientWidth - LABELS); }

  /** @param {any} lanes */
  show(lanes) {
    if (lanes.search !== study.search || lanes.goal !== study.goal) return;
    this.lanes = lanes;
    this.draw();
  }

  draw() {
    const { canvas, place } = this;
    const [width, height] = [canvas.clientWidth, Math.max(HEIGHT, place.clientHeight)];
    const c = cleared(canvas, width, height);
    const below = `${Math.max(0, this.count() * HEIGHT - height)}px`;
    if (this.below.style.height !== below) this.below.style.height = below;
    const lanes = this.lanes?.lanes ?? [];
    // What is drawn, for tests.
    canvas.dataset.lanes = lanes.map(({ number, fate }) => `${number}:${fate}`).join(" ");
    if (!c) return;
    const color = colors();
    const shades = this.shades(color);
    lanes.forEach((lane, at) => this.lane(c, color, shades, lane, ((this.lanes?.first ?? 0) + at) * HEIGHT - place.scrollTop));
  }

  /** Colours from good to bad. @param {(name: string) => string} color */
  shades(color) {
    const rgb = (/** @type {string} */ name) => [1, 3, 5].map((at) => parseInt(color(name).trim().slice(at, at + 2), 16));
    const [good, bad] = [rgb("--accent"), rgb("--await")];
    const mix = (/** @type {number} */ share) => good.map((part, at) => Math.round(part + share * (bad[at] - part))).join(" ");
    return Array.from({ length: SHADES }, (_, at) => `rgb(${mix(at / (SHADES - 1))})`);
  }

  /** @param {CanvasRenderingContext2D} c @param {(name: string) => string} color @param {string[]} shades @param {import("./study.js").Lane} lane @param {number} y */
  lane(c, color, shades, lane, y) {
    const isBest = lane.number === search()?.best;
    if (lane.number === study.selected) {
      c.fillStyle = color("--frame");
      c.fillRect(0, y, this.canvas.clientWidth, HEIGHT);
    }
    c.fillStyle = lane.number === study.selected ? color("--accent") : color("--ink");
    c.fillText(`${isBest ? "★ " : ""}${lane.number}`, 6, y + HEIGHT / 2, 60);
    const unit = study.about?.goals[study.goal].unit;
    const value = lane.goals[study.goal];
    c.fillStyle = color(lane.fate === "failed" ? "--bad" : lane.fate === "complete" ? "--ink" : "--soft");
    const words = { complete: number(value, unit), failed: "failed", stopped: "stopped", running: "running" };
    c.fillText(words[lane.fate], 72, y + HEIGHT / 2, LABELS - 82);
    const wide = this.width() / Math.max(1, lane.cells.length);
    c.fillStyle = color("--rule");
    c.fillRect(LABELS, y + HEIGHT / 2, this.width(), 1);
    const [good, bad] = study.state?.ranges[study.goal] ?? [0, 1];
    lane.cells.forEach((cell, at) => {
      if (cell === null) return;
      const share = cell === false ? 0 : Math.min(Math.max((cell - good) / (bad - good || 1), 0), 1);
      c.fillStyle = cell === false ? color("--bad") : shades[Math.round(share * (SHADES - 1))];
      // A failed run is higher than the others.
      const [above, high] = cell === false ? [1, HEIGHT - 2] : [4, HEIGHT - 8];
      c.fillRect(LABELS + at * wide, y + above, Math.max(1, wide > 3 ? wide - 1 : wide), high);
    });
  }

  /** The lane at a place in the canvas. @param {MouseEvent} event */
  at(event) {
    const row = Math.floor((event.offsetY + this.place.scrollTop) / HEIGHT);
    return this.lanes?.lanes[row - this.lanes.first];
  }

  /** The run under the pointer, in words. @param {MouseEvent} event @param {import("./study.js").Lane} lane */
  run(event, lane) {
    if (event.offsetX < LABELS) return `candidate ${lane.number}`;
    const seeds = study.about?.seeds ?? [];
    const at = Math.min(Math.floor(((event.offsetX - LABELS) / this.width()) * lane.cells.length), lane.cells.length - 1);
    const [first, end] = [at, at + 1].map((column) => Math.floor((column * seeds.length) / lane.cells.length));
    const cell = lane.cells[at];
    const missing = lane.fate === "running" ? "not yet" : "not necessary";
    const words = cell === false ? "failed" : cell === null || cell === undefined ? missing : number(cell, study.about?.goals[study.goal].unit);
    const of = end - first > 1 ? `seeds ${seeds[first]} to ${seeds[end - 1]}, the worst: ` : `seed ${seeds[first]}: `;
    return `candidate ${lane.number}\n${of}${words}`;
  }

  /** Selects a candidate and brings it into view. @param {number | null} candidate */
  look(candidate) {
    select(candidate);
    if (candidate === null) return;
    this.stop();
    const row = this.isBestFirst ? 0 : candidate;
    this.place.scrollTop = Math.max(0, row * HEIGHT - this.place.clientHeight / 2);
    this.request();
  }

  /** Selects the next candidate in the order of the lanes. @param {number} by */
  step(by) {
    const lanes = this.lanes?.lanes ?? [];
    const at = lanes.findIndex((lane) => lane.number === (study.selected ?? search()?.best));
    const next = lanes[at < 0 ? 0 : at + by];
    if (!next) return;
    this.stop();
    select(next.number);
    const top = ((this.lanes?.first ?? 0) + Math.max(0, at + by)) * HEIGHT;
    const { scrollTop, clientHeight } = this.place;
    if (top < scrollTop) this.place.scrollTop = top;
    if (top + HEIGHT > scrollTop + clientHeight) this.place.scrollTop = top + HEIGHT - clientHeight;
  }

  /** Follows the newest candidates, or no longer. */
  follow() {
    this.isFollowing = !this.isFollowing;
    element("follow").setAttribute("aria-pressed", String(this.isFollowing));
    if (this.isFollowing) this.grow();
  }

  stop() {
    if (this.isFollowing) this.follow();
  }

  /** Shows the best candidates first, or all in the order of the search. */
  reorder() {
    this.isBestFirst = !this.isBestFirst;
    element("order").setAttribute("aria-pressed", String(this.isBestFirst));
    this.place.scrollTop = 0;
    this.grow();
  }

  listen() {
    const { canvas, place } = this;
    element("follow").addEventListener("click", () => this.follow());
    element("order").addEventListener("click", () => this.reorder());
    place.addEventListener("scroll", () => {
      this.request();
      this.draw();
    });
    place.addEventListener("wheel", () => this.stop(), { passive: true });
    canvas.addEventListener("pointermove", (event) => {
      const lane = this.at(event) ?? null;
      hover(lane);
      tip(lane && this.run(event, lane), event);
    });
    canvas.addEventListener("pointerleave", () => {
      hover(null);
      tip(null);
    });
    canvas.addEventListener("click", (event) => {
      const lane = this.at(event);
      if (!lane) return;
      this.stop();
      select(lane.number);
    });
    canvas.addEventListener("keydown", (event) => {
      const by = { ArrowUp: -1, ArrowDown: 1 }[event.key];
      if (by === undefined) return;
      event.preventDefault();
      this.step(by);
    });
    addEventListener("resize", () => {
      this.draw();
      this.request();
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }
}
