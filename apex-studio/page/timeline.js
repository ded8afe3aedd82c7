// @ts-check
// The timeline: a lane for each node that was active, failed, or is looked for, below the graphs around it.
import { around, below, common } from "./activity.js";
import { ask, cleared, colors, element, marks, tip } from "./page.js";
import { robot, select, shown } from "./studio.js";

const HEIGHT = 18;
const LABELS = 170;
const AXIS = 20;
/** Space before a lane in a graph, in pixels. */
const STEP = 10;

/** A lane of the studio. @typedef {{node: number, spans: [number, number][], ticks: [number, number][], marks: number[]}} Lane */
/** A row: a lane, or a graph with the lanes in it. @typedef {{path: string, label: string, depth: number, lanes: Lane[], isGraph: boolean}} Row */
/** @typedef {{path: string, label: string, lane: Lane | null, inside: Map<string, Branch>}} Branch */

/** The lanes of a branch and of all in it. @param {Branch} branch @returns {Lane[]} */
const lanesOf = ({ lane, inside }) => [...(lane ? [lane] : []), ...[...inside.values()].flatMap(lanesOf)];

/** The rows of a branch. Of a graph with a single lane or graph in it, both are one row. @param {Branch} branch @param {number} depth @param {Set<string>} folded @returns {Row[]} */
function rowsOf({ path, label, lane, inside }, depth, folded) {
  const [only, ...others] = inside.values();
  if (only && others.length === 0 && !lane) return rowsOf({ ...only, label: `${label}.${only.label}` }, depth, folded);
  if (!only) return lane ? [{ path, label, depth, lanes: [lane], isGraph: false }] : [];
  const own = { path, label, depth, lanes: lanesOf({ path, label, lane, inside }), isGraph: true };
  return folded.has(path) ? [own] : [own, ...[...inside.values()].flatMap((branch) => rowsOf(branch, depth + 1, folded))];
}

/** Times in which at least one of these lanes is active. @param {Lane[]} lanes @returns {[number, number][]} */
function together(lanes) {
  /** @type {[number, number][]} */ const all = [];
  for (const [from, to] of lanes.flatMap(({ spans }) => spans).sort(([a], [b]) => a - b)) {
    const last = all[all.length - 1];
    if (last && last[1] >= from) last[1] = Math.max(last[1], to);
    else all.push([from, to]);
  }
  return all;
}

export class Timeline {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    /** All lanes, of which the canvas shows those in view. */
    this.place = element("lanes");
    this.below = element("lanes-below");
    /** Seen time in s. */
    this.span = 30;
    this.end = 0;
    this.isFollowing = true;
    this.stale = false;
    /** Time of the last request in ms. */
    this.asked = 0;
    /** @type {number | null} */ this.cursor = null;
    /** A marked interval in s. @type {[number, number] | null} */ this.marked = null;
    /** The last answer. @type {{from: number, to: number, columns: number, lanes: Lane[], before: Lane[], differs: number | null} | null} */
    this.lanes = null;
    /** Graphs whose lanes are shown as one. @type {Set<string>} */ this.folded = new Set();
    this.begin();
    this.listen();
  }

  begin() {
    this.span = 30;
    this.end = 0;
    this.isFollowing = true;
    this.lanes = null;
    this.cursor = null;
    this.asked = 0;
    this.draw();
  }

  /** Time has passed. */
  tick() {
    if (this.isFollowing) this.end = Math.max(robot.now, this.span);
    if (this.isFollowing || this.stale) this.request();
  }

  /** Asks for what is to be seen, not more often than can be drawn. */
  request() {
    const now = performance.now();
    if (now - this.asked < 100) {
      this.stale = true;
      return;
    }
    this.stale = false;
    this.asked = now;
    const filter = element("lanes-filter").value.toLowerCase();
    const found = filter === "" ? [] : (robot.about?.nodes ?? []).flatMap((node, at) => (node.name.toLowerCase().includes(filter) ? [at] : []));
    const selected = robot.about?.nodes.findIndex((node) => node.name === robot.selected) ?? -1;
    const also = selected >= 0 ? [...found.slice(0, 200), selected] : found.slice(0, 200);
    // What is not in view has no contents. At first it is not known who has a lane.
    const [first, end] = this.rows();
    const rows = this.tree().slice(Math.max(0, first - 5), end + 5).filter(({ isGraph, path }) => !isGraph || this.folded.has(path));
    const seen = this.lanes === null ? null : rows.flatMap(({ lanes }) => lanes.map(({ node }) => node));
    ask({ lanes: { from: this.end - this.span, to: this.end, columns: Math.max(1, this.width()), also, seen } });
  }

  /** Numbers of the first row in view, and of the one after the last. @returns {[number, number]} */
  rows() {
    const { scrollTop, clientHeight } = this.place;
    return [Math.floor(scrollTop / HEIGHT), Math.ceil((scrollTop + clientHeight - AXIS) / HEIGHT)];
  }

  /** The row at a place in the canvas. @param {MouseEvent} event */
  at(event) {
    return event.offsetY < AXIS ? undefined : this.tree()[Math.floor((event.offsetY - AXIS + this.place.scrollTop) / HEIGHT)];
  }

  width() { return Math.round(this.canvas.clientWidth - LABELS); }

  /** @param {any} lanes */
  show(lanes) {
    this.lanes = lanes;
    this.draw();
  }

  /** Lanes that pass the filter. */
  filtered() {
    const filter = element("lanes-filter").value.toLowerCase();
    const name = (/** @type {number} */ node) => robot.about?.nodes[node]?.name ?? "";
    return (this.lanes?.lanes ?? []).filter(({ node }) => name(node).toLowerCase().includes(filter));
  }

  /** The lanes below the graphs around them, whose common path is left out. @returns {Row[]} */
  tree() {
    const lanes = this.filtered();
    const name = (/** @type {Lane} */ { node }) => robot.about?.nodes[node]?.name ?? "";
    const path = common(lanes.map((lane) => around(name(lane))));
    /** @type {Branch} */ const root = { path, label: "", lane: null, inside: new Map() };
    for (const lane of lanes) {
      let at = root;
      for (const label of below(name(lane), path).split(".")) {
        const next = at.inside.get(label) ?? { path: at.path === "" ? label : `${at.path}.${label}`, label, lane: null, inside: new Map() };
        at.inside.set(label, next);
        at = next;
      }
      at.lane = lane;
    }
    return [...root.inside.values()].flatMap((branch) => rowsOf(branch, 0, this.folded));
  }

  draw() {
    const { canvas } = this;
    const color = colors();
    const [lanes, rows] = [this.filtered(), this.tree()];
    const [width, height] = [canvas.clientWidth, Math.max(AXIS + HEIGHT, this.place.clientHeight)];
    const c = cleared(canvas, width, height);
    const below = `${Math.max(0, AXIS + rows.length * HEIGHT - height)}px`;
    if (this.below.style.height !== below) this.below.style.height = below;
    if (!c) return;
    canvas.dataset.window = `${this.end - this.span} ${this.end}`;
    canvas.dataset.rows = rows.map(({ depth, label }) => `${" ".repeat(depth)}${label}`).join("\n");
    canvas.dataset.lanes = lanes.map(({ node }) => robot.about?.nodes[node].name).join(" ");
    c.save();
    c.beginPath();
    c.rect(0, AXIS, width, height);
    c.clip();
    const [first, end] = this.rows();
    rows.slice(first, end).forEach((row, at) => this.row(c, color, row, AXIS + (first + at) * HEIGHT - this.place.scrollTop));
    c.restore();
    this.axis(c, color, height);
    if (this.marked !== null) {
      const [a, b] = this.marked.map((time) => Math.max(LABELS, this.x(time)));
      c.fillStyle = color("--accent");
      c.globalAlpha = 0.15;
      c.fillRect(a, 0, Math.max(1, b - a), height);
      c.globalAlpha = 1;
    }
    const differs = this.lanes?.differs ?? null;
    if (differs !== null && this.x(differs) >= LABELS) {
      c.fillStyle = color("--bad");
      c.fillRect(this.x(differs), 0, 1.5, height);
    }
    const other = robot.beside === null ? "the run before" : robot.beside === "shadow" ? "its shadow" : "the robot";
    element("differs").textContent = differs === null ? "" : `differs from ${other} since ${shown(differs)}`;
    // No line goes through the names.
    if (this.cursor !== null && this.x(this.cursor) >= LABELS) {
      c.fillStyle = color("--accent");
      c.fillRect(this.x(this.cursor), 0, 1.5, height);
    }
    element("window").textContent = `${shown(Math.max(0, this.end - this.span))} – ${shown(this.end)}`;
  }

  /** @param {CanvasRenderingContext2D} c @param {(name: string) => string} color @param {number} height */
  axis(c, color, height) {
    const [times, digits] = marks(Math.max(0, this.end - this.span), this.end, Math.max(2, this.width() / 110));
    c.fillStyle = color("--soft");
    for (const t of times) {
      c.fillText(`${t.toFixed(digits)} s`, this.x(t) + 3, AXIS / 2);
      c.globalAlpha = 0.3;
      c.fillRect(this.x(t), 0, 1, height);
      c.globalAlpha = 1;
    }
  }

  /** @param {CanvasRenderingContext2D} c @param {(name: string) => string} color @param {Row} row @param {number} y */
  row(c, color, { path, label, depth, lanes, isGraph }, y) {
    c.fillStyle = path === robot.selected ? color("--accent") : isGraph ? color("--soft") : color("--ink");
    const left = 6 + depth * STEP + (isGraph ? 0 : STEP);
    const words = isGraph ? `${this.folded.has(path) ? "▸" : "▾"} ${label}` : label;
    const most = Math.floor((LABELS - left - 4) / 6.5);
    c.fillText(words.length > most ? `${words.slice(0, most - 1)}…` : words, left, y + HEIGHT / 2, LABELS - left - 4);
    if (!isGraph) this.lane(c, color, lanes[0], y);
    else if (this.folded.has(path)) this.lane(c, color, { node: -1, spans: together(lanes), ticks: [], marks: lanes.flatMap(({ marks }) => marks) }, y);
  }

  /** @param {CanvasRenderingContext2D} c @param {(name: string) => string} color @param {Lane} lane @param {number} y */
  lane(c, color, { node, spans, ticks, marks }, y) {
    const { from, to, columns } = /** @type {any} */ (this.lanes);
    const x = (/** @type {number} */ column) => this.x(from + ((to - from) * column) / columns);
    c.save();
    c.beginPath();
    c.rect(LABELS, 0, this.width(), 1e6);
    c.clip();
    c.fillStyle = color("--active");
    for (const [a, b] of spans) c.fillRect(x(a), y + 2, Math.max(1, x(b) - x(a)), HEIGHT - 9);
    const before = this.lanes?.before.find((other) => other.node === node);
    c.fillStyle = color("--soft");
    for (const [a, b] of before?.spans ?? []) c.fillRect(x(a), y + HEIGHT - 9, Math.max(1, x(b) - x(a)), 2);
    c.fillStyle = color("--fire");
    const most = Math.max(1, ...ticks.map((/** @type {[number, number]} */ [, count]) => count));
    for (const [at, count] of ticks) {
      const tall = 2 + 3 * Math.sqrt(count / most);
      c.fillRect(x(at), y + HEIGHT - 1 - tall, 1, tall);
    }
    c.fillStyle = color("--bad");
    for (const at of marks) {
      c.beginPath();
      c.arc(x(at), y + HEIGHT / 2, 4, 0, 7);
      c.fill();
    }
    c.restore();
  }

  /** @param {number} time */
  x(time) { return LABELS + ((time - this.end + this.span) / this.span) * this.width(); }

  /** @param {MouseEvent} event */
  time(event) {
    return this.end - this.span + ((event.offsetX - LABELS) / this.width()) * this.span;
  }

  /** Shows the lanes of a graph as one, or each. @param {string} path */
  fold(path) {
    if (!this.folded.delete(path)) this.folded.add(path);
    this.request();
    this.draw();
  }

  /** Brings a time into view. @param {number} time */
  look(time) {
    this.cursor = time;
    if (time < this.end - this.span || time > this.end) {
      this.stop();
      this.end = time + this.span / 2;
    }
    this.request();
    this.draw();
  }

  /** Shows a longer or shorter time around the cursor. @param {number} by */
  scale(by) {
    const [time, span] = [this.cursor ?? this.end, Math.min(Math.max(this.span * by, 0.002), 86400)];
    if (!this.isFollowing) this.end = time + ((this.end - time) * span) / this.span;
    this.span = span;
    this.request();
    this.draw();
  }

  /** Lets the robot go to the cursor. */
  go() {
    if (this.cursor !== null) ask({ goto: this.cursor });
  }

  /** Follows the time again. */
  follow() {
    this.isFollowing = !this.isFollowing;
    element("follow").setAttribute("aria-pressed", String(this.isFollowing));
    this.tick();
  }

  stop() {
    this.isFollowing = false;
    element("follow").setAttribute("aria-pressed", "false");
  }

  listen() {
    const { canvas } = this;
    element("follow").addEventListener("click", () => this.follow());
    element("lanes-filter").addEventListener("input", () => this.request());
    this.place.addEventListener("scroll", () => {
      this.request();
      this.draw();
    });
    canvas.addEventListener("wheel", (event) => {
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
        this.stop();
        this.end = Math.max(0, this.end + ((event.deltaX || event.deltaY) / this.width()) * this.span);
      } else {
        const [time, by] = [this.time(event), event.deltaY > 0 ? 1.2 : 1 / 1.2];
        const span = Math.min(Math.max(this.span * by, 0.002), 86400);
        if (!this.isFollowing) this.end = time + ((this.end - time) * span) / this.span;
        this.span = span;
      }
      event.preventDefault();
      this.request();
      this.draw();
    }, { passive: false });
    let drag = /** @type {{x: number, moved: boolean, marks: number | null} | null} */ (null);
    canvas.addEventListener("pointerdown", (event) => {
      drag = { x: event.clientX, moved: false, marks: event.ctrlKey ? this.time(event) : null };
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!drag) {
        const name = this.at(event)?.path;
        tip(event.offsetX > LABELS ? [name, shown(this.time(event))].filter(Boolean).join("\n") : name ?? null, event);
        return;
      }
      const by = event.clientX - drag.x;
      if (!drag.moved && Math.abs(by) < 4) return;
      if (!drag.moved) canvas.setPointerCapture(event.pointerId);
      if (drag.marks !== null) {
        drag.moved = true;
        canvas.dispatchEvent(new CustomEvent("mark", { detail: [drag.marks, this.time(event)] }));
        return;
      }
      this.stop();
      this.end -= (by / this.width()) * this.span;
      drag = { x: event.clientX, moved: true, marks: null };
      this.request();
      this.draw();
    });
    canvas.addEventListener("pointerup", (event) => {
      if (drag && !drag.moved) {
        const row = this.at(event);
        if (row?.isGraph && event.offsetX <= LABELS) this.fold(row.path);
        if (row) select(row.path);
        if (event.offsetX > LABELS) this.look(this.time(event));
      }
      drag = null;
    });
    canvas.addEventListener("pointerleave", () => tip(null));
    canvas.addEventListener("keydown", (event) => {
      const by = (this.span / 100) * (event.shiftKey ? 10 : 1);
      /** @type {Record<string, () => void>} */
      const keys = {
        ArrowLeft: () => this.look(Math.max(0, (this.cursor ?? robot.now) - by)),
        ArrowRight: () => this.look((this.cursor ?? robot.now) + by),
        ArrowUp: () => this.scale(1 / 1.2),
        ArrowDown: () => this.scale(1.2),
      };
      if (!keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
    // For the pictures of the documentation.
    canvas.addEventListener("look", (event) => {
      const [from, to, cursor] = /** @type {CustomEvent} */ (event).detail;
      this.stop();
      Object.assign(this, { span: to - from, end: to, cursor });
      this.request();
      this.draw();
    });
    addEventListener("resize", () => this.request());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }
}
