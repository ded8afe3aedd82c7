// @ts-check
// The picture of the robot: the SVG of `apex graph`, alive.
import { ask, tip } from "./page.js";
import { robot, select } from "./studio.js";

/** @typedef {{within: string, names: string[], connects: boolean, text: string}} Concern */

/** An element of the picture, with the classes of its state that it has. @typedef {{element: Element, state: number}} Shown */

/** `true` for a node that the compiler has inserted into a connection. @param {number} node */
const isInserted = (node) => ["relay", "probe"].includes(robot.about?.nodes[node]?.kind ?? "");

/** Pixels per unit of the picture from which on its words, of 10 units and more, can be read. */
const READABLE = 0.3;

/** Classes of the state of boxes, and of lines. */
const BOX = ["is-active", "is-firing", "has-problem", "is-waiting"];
const LINE = ["flows", "is-awaited"];

/** Gives an element the classes of its state. Only those that change are touched: the browser styles and paints what was.
 * @param {Shown} shown @param {string[]} classes @param {boolean[]} states */
function show(shown, classes, states) {
  const state = states.reduce((sum, is, at) => sum | (Number(is) << at), 0);
  if (state === shown.state) return;
  for (const [at, name] of classes.entries()) if (((state ^ shown.state) >> at) & 1) shown.element.classList.toggle(name, states[at]);
  shown.state = state;
}

export class Picture {
  /** @param {HTMLElement} place */
  constructor(place) {
    this.place = place;
    /** @type {SVGSVGElement | null} */ this.svg = null;
    /** @type {Map<string, Shown & {nodes: number[], path: string}>} */ this.items = new Map();
    /** @type {(Shown & {connections: number[]})[]} */ this.lines = [];
    /** For each connection the nodes before and behind it, if a token takes both to fire. @type {([number[], number[]] | null)[]} */ this.flow = [];
    /** @type {string[]} */ this.graphs = [];
    /** @type {Set<string>} */ this.open = new Set();
    /** A node to be shown when its graph is open. @type {string | null} */ this.wanted = null;
    /** Nodes of the last answer to "why". @type {Set<number>} */ this.lit = new Set();
    /** What the errors of the text concern. @type {Concern[]} */ this.concerns = [];
    /** Errors of the text, by what they concern. @type {Map<Element, string>} */ this.errors = new Map();
    this.view = { x: 0, y: 0, width: 1, height: 1 };
    this.listen();
  }

  /** Shows a picture. @param {{svg: string, graphs: string[], open: string[], lines: Record<string, number[]>}} told */
  show({ svg, graphs, open, lines }) {
    const parsed = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
    if (parsed.localName !== "svg") return;
    const before = this.svg;
    this.svg = /** @type {any} */ (document.importNode(parsed, true));
    this.svg?.removeAttribute("width");
    this.svg?.removeAttribute("height");
    this.graphs = graphs;
    this.open = new Set(open);
    this.place.replaceChildren(/** @type {any} */ (this.svg));
    // Names are unique; a node inside a graph also lets the graph appear active.
    const names = robot.about?.nodes.map((node) => node.name) ?? [];
    this.items.clear();
    for (const element of this.svg?.querySelectorAll("[data-item]") ?? []) {
      const path = element.getAttribute("data-item") ?? "";
      const inside = (/** @type {string} */ name) => name === path || name.startsWith(`${path}.`);
      const nodes = names.flatMap((name, at) => (inside(name) ? [at] : []));
      if (path !== "") this.items.set(path, { element, nodes, path, state: 0 });
      element.classList.toggle("can-open", graphs.includes(path));
    }
    this.lines = [...(this.svg?.querySelectorAll("[data-from]") ?? [])].map((element) => ({
      element,
      state: 0,
      connections: lines[`${element.getAttribute("data-from")} ${element.getAttribute("data-to")}`] ?? [],
    }));
    this.flow = (robot.about?.connections ?? []).map((connection) =>
      this.isEvent(connection) ? null : [this.behind(connection.from, true), this.behind(connection.to, false)]);
    const size = this.svg?.viewBox.baseVal;
    if (size) this.size = { width: size.width, height: size.height };
    if (!before || !this.shownBefore) this.fit();
    else this.look();
    this.shownBefore = true;
    this.select(robot.selected);
    this.update();
    this.heat();
    this.relight();
    this.wrong(this.concerns);
    if (this.wanted) this.jump(this.wanted);
  }

  /** Forgets the picture of a robot. */
  forget() {
    this.svg = null;
    this.items.clear();
    this.lines = [];
    this.concerns = [];
    this.place.replaceChildren();
  }

  /** Shows what is active, fires and fails. */
  update() {
    const waiting = new Set([...robot.awaited].map((at) => robot.about?.connections[at]?.to));
    for (const item of this.items.values()) {
      const is = (/** @type {(node: import("./studio.js").NodeState) => boolean} */ test) => item.nodes.some((at) => test(robot.nodes[at]));
      const waits = item.nodes.length === 1 && waiting.has(item.nodes[0]);
      show(item, BOX, [is((node) => node.active), is((node) => node.fresh), is((node) => node.problems > 0), waits]);
    }
    for (const line of this.lines) {
      const { connections } = line;
      show(line, LINE, [connections.some((at) => this.flows(at)), connections.some((at) => robot.awaited.has(at))]);
    }
  }

  /** Colours all boxes by their share of the computing time. */
  heat() {
    const { times } = robot;
    const total = [...(times?.values() ?? [])].reduce((sum, { total }) => sum + total, 0);
    for (const { element, nodes } of this.items.values()) {
      const own = nodes.reduce((sum, at) => sum + (times?.get(at)?.total ?? 0), 0);
      const share = total > 0 ? own / total : 0;
      element.classList.toggle("is-hot", times !== null && share > 0);
      /** @type {SVGElement} */ (element).style.setProperty("--heat", share.toFixed(3));
    }
  }

  /** Words about the computing time of a node. @param {number} at */
  timeWords(at) {
    const [times, all] = [robot.times?.get(at), [...(robot.times?.values() ?? [])]];
    if (!times) return "";
    const share = (100 * times.total) / all.reduce((sum, { total }) => sum + total, 1);
    const us = (/** @type {number} */ ns) => `${(ns / 1000).toFixed(1)} µs`;
    return `\n${share.toFixed(1)} % of the time; ${us(times.total / times.calls)} on average, ${us(times.worst)} at worst`;
  }

  /** `true` if a token has just come over a connection. @param {number} at */
  flows(at) {
    if (robot.connections[at]?.fresh) return true;
    const fire = (/** @type {number[]} */ nodes) => nodes.some((node) => robot.nodes[node].fresh);
    const ends = this.flow[at];
    return ends ? fire(ends[0]) && fire(ends[1]) : false;
  }

  /** The node itself, or if it only passes tokens on, those before or behind it. @param {number} node @param {boolean} back @returns {number[]} */
  behind(node, back, depth = 0) {
    if (!isInserted(node) || depth > 8) return [node];
    const all = robot.about?.connections ?? [];
    const next = back ? all.filter(({ to }) => to === node).map(({ from }) => from) : all.filter(({ from }) => from === node).map(({ to }) => to);
    return next.flatMap((other) => this.behind(other, back, depth + 1));
  }

  /** `true` if the connection ends at a slot. @param {import("./studio.js").Connection} connection */
  isEvent(connection) {
    const ports = robot.about?.nodes[connection.to].ports ?? [];
    return ports.find(([name]) => name === connection.input)?.[1] === "slot";
  }

  /** Lights up these nodes, and the lines between them. @param {number[]} nodes */
  light(nodes) {
    this.lit = new Set(nodes);
    this.relight();
  }

  relight() {
    const { lit } = this;
    for (const { element, nodes } of this.items.values()) element.classList.toggle("is-cause", nodes.some((at) => lit.has(at)));
    for (const { element, connections } of this.lines) {
      const ends = connections.flatMap((at) => robot.about?.connections[at] ?? []);
      element.classList.toggle("is-lit", ends.some(({ from, to }) => lit.has(from) && lit.has(to)));
    }
  }

  /** Lays errors of the text over the picture. @param {Concern[]} concerns */
  wrong(concerns) {
    this.concerns = concerns;
    this.errors.clear();
    for (const { within, names, connects, text } of concerns) {
      const places = connects ? names.slice(1).flatMap((name, at) => this.between(within, names[at], name)) : [];
      const all = places.length > 0 ? places : names.map((name) => this.around(within === "" ? name : `${within}.${name}`));
      for (const element of all) if (element) this.errors.set(element, text);
    }
    for (const { element } of [...this.items.values(), ...this.lines]) element.classList.toggle("is-wrong", this.errors.has(element));
  }

  /** The lines between two nodes, or ports, of a graph. @param {string} within @param {string} from @param {string} to */
  between(within, from, to) {
    const is = (/** @type {string | null} */ end, /** @type {string} */ name) =>
      end === `${within}:${name}` || end?.split(":")[0] === (within === "" ? name : `${within}.${name}`);
    return this.lines.flatMap(({ element }) => (is(element.getAttribute("data-from"), from) && is(element.getAttribute("data-to"), to) ? [element] : []));
  }

  /** A node, or the closed graph that it is in. @param {string} name */
  around(name) {
    for (let path = name; path !== ""; path = path.slice(0, Math.max(0, path.lastIndexOf(".")))) {
      const item = this.items.get(path);
      if (item) return item.element;
    }
    return null;
  }

  /** @param {string | null} name */
  select(name) {
    for (const { element, path } of this.items.values()) element.classList.toggle("is-selected", path === name);
  }

  /** Selects a node and brings it into view, and opens the graphs around it. @param {string} name @param {number} smallest */
  jump(name, smallest = 30) {
    const around = this.graphs.filter((graph) => name.startsWith(`${graph}.`));
    if (around.some((graph) => !this.open.has(graph))) {
      this.wanted = name;
      around.forEach((graph) => this.open.add(graph));
      ask({ open: [...this.open] });
      return;
    }
    this.wanted = null;
    select(name);
    const box = /** @type {any} */ (this.items.get(name)?.element)?.getBoundingClientRect();
    const place = this.place.getBoundingClientRect();
    if (!box) return;
    const is = box.left >= place.left && box.right <= place.right && box.top >= place.top && box.bottom <= place.bottom;
    if (is && box.width > smallest) return;
    const scale = this.view.width / place.width;
    this.view.x += ((box.left + box.right) / 2 - (place.left + place.right) / 2) * scale;
    this.view.y += ((box.top + box.bottom) / 2 - (place.top + place.bottom) / 2) * scale;
    this.look();
  }

  /** Selects the nearest box in a direction. @param {number} dx @param {number} dy */
  step(dx, dy) {
    const boxes = [...this.items.values()].filter(({ element }) => !element.classList.contains("frame")).map((item) => {
      const { left, right, top, bottom } = item.element.getBoundingClientRect();
      return { ...item, x: (left + right) / 2, y: (top + bottom) / 2, bottom };
    });
    const from = boxes.find(({ path }) => path === robot.selected);
    const cost = (/** @type {typeof boxes[0]} */ { x, y }) => {
      if (!from) return x + y;
      const [along, across] = [(x - from.x) * dx + (y - from.y) * dy, Math.abs((x - from.x) * dy) + Math.abs((y - from.y) * dx)];
      return along > 2 ? along + 2 * across : Infinity;
    };
    const best = boxes.reduce((best, box) => (cost(box) < cost(best) ? box : best), boxes[0]);
    if (!best || cost(best) === Infinity) return;
    this.jump(best.path, 0);
    const { left, bottom } = best.element.getBoundingClientRect();
    tip(this.words(best.element), /** @type {any} */ ({ clientX: left, clientY: bottom - 8 }));
  }

  /** Opens or closes a nested graph. @param {string | null} name */
  toggle(name) {
    const graph = this.graphs.includes(name ?? "") ? name : this.graphs.filter((g) => name?.startsWith(`${g}.`)).sort((a, b) => b.length - a.length)[0];
    if (!graph) return;
    if (!this.open.delete(graph)) this.open.add(graph);
    ask({ open: [...this.open] });
  }

  /** Shows all of it. */
  fit() {
    const { width = 1, height = 1 } = this.size ?? {};
    this.view = { x: 0, y: 0, width, height };
    this.look();
  }

  /** @param {number} factor @param {MouseEvent} [at] */
  zoom(factor, at) {
    const place = this.place.getBoundingClientRect();
    const [fx, fy] = at ? [(at.clientX - place.left) / place.width, (at.clientY - place.top) / place.height] : [0.5, 0.5];
    const { x, y, width, height } = this.view;
    const all = this.size?.width ?? width;
    const by = Math.min(Math.max(factor, 60 / width), (4 * all) / width);
    this.view = { x: x + fx * width * (1 - by), y: y + fy * height * (1 - by), width: width * by, height: height * by };
    this.look();
  }

  look() {
    const { x, y, width, height } = this.view;
    this.svg?.setAttribute("viewBox", `${x} ${y} ${width} ${height}`);
    const scale = Math.min(this.place.clientWidth / width, this.place.clientHeight / height);
    this.place.classList.toggle("is-far", scale < READABLE);
  }

  /** Words about what is under the pointer. @param {Element} target */
  words(target) {
    const line = this.lines.find(({ element }) => element === target);
    if (line) {
      const title = target.querySelector("title")?.textContent ?? "";
      const words = new Set(line.connections.map((at) => this.flowWords(at)));
      return [title, ...[...words].slice(0, 6), this.errors.get(target) ?? ""].filter(Boolean).join("\n");
    }
    const path = target.closest("[data-item]")?.getAttribute("data-item");
    const item = path ? this.items.get(path) : undefined;
    if (!item) return null;
    const title = target.closest("[data-item]")?.querySelector(":scope > title")?.textContent ?? "";
    const error = this.errors.get(item.element);
    const head = error ? `${title}\n${error}` : title;
    if (item.nodes.length !== 1) return head;
    const node = robot.nodes[item.nodes[0]];
    const fired = node.fired === 0 ? "has not fired" : `fired ${node.fired} times, ${node.rate.toFixed(1)}/s; ${this.ago(node.last)}`;
    const missing = [...robot.awaited].flatMap((at) => robot.about?.connections[at] ?? []).filter(({ to }) => to === item.nodes[0]);
    const waits = missing.length === 0 ? "" : `\nwaits for ${missing.map(({ from, output }) => `${robot.about?.nodes[from].name}.${output}`).join(", ")}`;
    const problems = node.problems > 0 ? `\n${node.problems} problems` : "";
    return `${head}\n${node.active ? "active; " : ""}${fired}${waits}${problems}${this.timeWords(item.nodes[0])}`;
  }

  /** @param {number} at */
  flowWords(at) {
    const connection = robot.about?.connections[at];
    if (!connection) return "";
    if (!this.isEvent(connection)) {
      if (isInserted(connection.from)) return "";
      const node = robot.nodes[connection.from];
      return node.fired === 0 ? "its source has not fired" : `${node.rate.toFixed(1)}/s; ${this.ago(node.last)}`;
    }
    const { count, rate } = robot.connections[at];
    return count === 0 ? "no token yet" : `${count} tokens, ${rate.toFixed(1)}/s`;
  }

  /** @param {number} time */
  ago(time) {
    return `last ${Math.max(0, robot.now - time).toFixed(3)} s ago`;
  }

  listen() {
    const { place } = this;
    place.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(event.deltaY > 0 ? 1.15 : 0.87, event);
    }, { passive: false });
    /** @type {{x: number, y: number, moved: boolean} | null} */
    let drag = null;
    place.addEventListener("pointerdown", (event) => { drag = { x: event.clientX, y: event.clientY, moved: false }; });
    place.addEventListener("pointermove", (event) => {
      if (!drag) {
        tip(this.words(/** @type {Element} */ (event.target)), event);
        return;
      }
      const [dx, dy] = [event.clientX - drag.x, event.clientY - drag.y];
      if (!drag.moved && Math.hypot(dx, dy) < 4) return;
      if (!drag.moved) place.setPointerCapture(event.pointerId);
      const scale = Math.max(this.view.width / place.clientWidth, this.view.height / place.clientHeight);
      this.view.x -= dx * scale;
      this.view.y -= dy * scale;
      drag = { x: event.clientX, y: event.clientY, moved: true };
      this.look();
    });
    place.addEventListener("pointerup", (event) => {
      const path = /** @type {Element} */ (event.target).closest("[data-item]")?.getAttribute("data-item") ?? null;
      if (drag && !drag.moved) select(path || null);
      drag = null;
    });
    place.addEventListener("pointerleave", () => tip(null));
    place.addEventListener("blur", () => tip(null));
    place.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (way) {
        event.preventDefault();
        this.step(way[0], way[1]);
      } else if (event.key === "Enter") this.toggle(robot.selected);
    });
    place.addEventListener("dblclick", (event) => {
      const path = /** @type {Element} */ (event.target).closest("[data-item]")?.getAttribute("data-item") ?? null;
      this.toggle(path);
    });
  }
}
