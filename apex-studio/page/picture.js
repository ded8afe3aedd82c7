// @ts-check
// The picture of the robot: the SVG of `apex graph`, alive.
import { duration, showDoing } from "./activity.js";
import { Labels } from "./labels.js";
import { ask, element, tip } from "./page.js";
import { robot, select } from "./studio.js";

/** @typedef {{within: string, names: string[], connects: boolean, text: string}} Concern */

/** An element of the picture, with the classes of its state that it has. @typedef {{element: Element, state: number}} Shown */
/** A box, with its nodes, and the line of words in which a state says since when it is active. @typedef {Shown & import("./labels.js").Box & {nodes: number[], since: Element | null, kind: string}} Item */
/** @typedef {{view: string, has_activity: boolean, svg: string, graphs: string[], open: string[], lines: Record<string, number[]>, states: number[]}} Drawing */

/** `true` for a node that the compiler has inserted into a connection. @param {number} node */
const isInserted = (node) => ["relay", "probe"].includes(robot.about?.nodes[node]?.kind ?? "");

/** Pixels per unit of the picture below which names are drawn at a size of their own, and below which changes of colour
 * are not seen. */
const READABLE = 0.8;
const FAR = 0.3;
/** Those below which ports have no names. */
const PORTS = 0.95;
/** The most for a small picture. */
const LARGEST = 1.6;
/** Space around what is shown, in pixels. */
const MARGIN = 12;

/** Classes of the state of boxes, and of lines. */
const BOX = ["is-active", "is-firing", "has-problem", "is-waiting"];
const LINE = ["flows", "is-awaited", "is-last"];

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
    this.labels = new Labels();
    /** What is shown: `activity` or `wiring`. */
    this.shown = "";
    /** Nodes that can be active. @type {number[]} */ this.states = [];
    /** The node that became active last. @type {string | null} */ this.doing = null;
    /** @type {Map<string, Item>} */ this.items = new Map();
    /** @type {(Shown & {connections: number[]})[]} */ this.lines = [];
    /** For each connection the nodes before and behind it, if a token takes both to fire. @type {([number[], number[]] | null)[]} */ this.flow = [];
    /** @type {string[]} */ this.graphs = [];
    /** @type {Set<string>} */ this.open = new Set();
    /** A node to be shown when its graph is open. @type {string | null} */ this.wanted = null;
    /** Nodes of the last answer to "why". @type {Set<number>} */ this.lit = new Set();
    /** What the errors of the text concern. @type {Concern[]} */ this.concerns = [];
    /** Errors of the text, by what they concern. @type {Map<Element, string>} */ this.errors = new Map();
    /** The upper left corner of the window in the picture, and pixels per unit. */
    this.view = { x: 0, y: 0, scale: 1 };
    this.size = { width: 1, height: 1 };
    /** `true` until the user has moved the picture: it is shown as a whole. */
    this.isWhole = true;
    /** A graph that is opened or closed, and its place in the window before. @type {{graph: string, left: number, top: number} | null} */ this.turned = null;
    this.listen();
  }

  /** Shows a picture. @param {Drawing} told */
  show({ view, has_activity, svg, graphs, open, lines, states }) {
    const parsed = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
    if (parsed.localName !== "svg") return;
    this.svg = /** @type {any} */ (document.importNode(parsed, true));
    const size = this.svg?.viewBox.baseVal;
    if (size) this.size = { width: size.width, height: size.height };
    this.svg?.removeAttribute("width");
    this.svg?.removeAttribute("height");
    const isOther = view !== this.shown;
    Object.assign(this, { shown: view, states, graphs, open: new Set(open) });
    element("views").hidden = !has_activity;
    for (const button of element("views").children) button.setAttribute("aria-pressed", String(button.dataset.view === view));
    this.place.dataset.view = view;
    this.place.replaceChildren(/** @type {any} */ (this.svg));
    // Names are unique; a node inside a graph also lets the graph appear active. A state machine is always in a state.
    const nodes = robot.about?.nodes ?? [];
    this.items.clear();
    for (const element of this.svg?.querySelectorAll("[data-item]") ?? []) {
      const path = element.getAttribute("data-item") ?? "";
      const inside = (/** @type {typeof nodes[0]} */ { name, kind }) => name === path || (kind !== "state" && name.startsWith(`${path}.`));
      if (path !== "") this.items.set(path, this.item(element, path, nodes.flatMap((node, at) => (inside(node) ? [at] : []))));
      element.classList.toggle("can-open", graphs.includes(path));
    }
    this.lines = [...(this.svg?.querySelectorAll("[data-from]") ?? [])].map((element) => ({
      element,
      state: 0,
      connections: lines[`${element.getAttribute("data-from")} ${element.getAttribute("data-to")}`] ?? [],
    }));
    this.flow = (robot.about?.connections ?? []).map((connection) =>
      this.isEvent(connection) ? null : [this.behind(connection.from, true), this.behind(connection.to, false)]);
    const boxes = [...this.items.values()].filter(({ width }) => width > 0);
    if (this.svg) this.labels.begin(this.svg, boxes, view === "activity" ? this.events() : []);
    if (isOther) this.turned = null;
    if (isOther || this.isWhole) this.fit();
    if (this.turned) this.keep(this.turned);
    this.turned = null;
    this.mark(robot.selected);
    this.look();
    this.update();
    this.heat();
    this.relight();
    this.wrong(this.concerns);
    if (this.wanted) this.jump(this.wanted);
  }

  /** The names of the events that end states, which are beside the boxes. */
  events() {
    return [...(this.svg?.querySelectorAll('text[font-size="10"]') ?? [])].map((text) => {
      const { x, y } = this.corner(text.parentElement);
      const [dx, dy] = ["x", "y"].map((side) => Number(text.getAttribute(side)));
      return { words: text.textContent ?? "", x: x + dx, y: y + dy, anchor: text.getAttribute("text-anchor") ?? "start" };
    });
  }

  /** The place of a group in the picture. @param {Element | null} group */
  corner(group) {
    let [x, y] = [0, 0];
    for (let at = group; at && at !== this.svg; at = at.parentElement) {
      const moved = /translate\((-?\d+) (-?\d+)\)/.exec(at.getAttribute("transform") ?? "");
      [x, y] = [x + Number(moved?.[1] ?? 0), y + Number(moved?.[2] ?? 0)];
    }
    return { x, y };
  }

  /** A box of the picture. @param {Element} element @param {string} path @param {number[]} nodes @returns {Item} */
  item(element, path, nodes) {
    const box = element.querySelector(":scope > rect.box");
    const [width, height] = ["width", "height"].map((side) => Number(box?.getAttribute(side) ?? 0));
    const isFrame = element.classList.contains("frame");
    // A state says below its name of which kind it is, or since when it is active.
    const since = this.shown === "activity" && !isFrame ? element.querySelectorAll(":scope > text")[1] ?? null : null;
    return { element, path, nodes, state: 0, ...this.corner(element), width, height, isFrame, since, kind: since?.textContent ?? "" };
  }

  /** Forgets the picture of a robot. */
  forget() {
    this.svg = null;
    this.shown = "";
    this.isWhole = true;
    this.items.clear();
    this.lines = [];
    this.concerns = [];
    this.states = [];
    element("views").hidden = true;
    element("does").hidden = true;
    delete this.place.dataset.view;
    this.place.replaceChildren();
  }

  /** Shows what is active, fires and fails. */
  update() {
    // In the view of the activity nothing else is to be seen.
    const isActivity = this.shown === "activity";
    const waiting = new Set([...robot.awaited].map((at) => robot.about?.connections[at]?.to));
    for (const item of this.items.values()) {
      const is = (/** @type {(node: import("./studio.js").NodeState) => boolean} */ test) => item.nodes.some((at) => test(robot.nodes[at]));
      const waits = item.nodes.length === 1 && waiting.has(item.nodes[0]);
      show(item, BOX, [is((node) => node.active), !isActivity && is((node) => node.fresh), is((node) => node.problems > 0), !isActivity && waits]);
      this.say(item);
    }
    const times = this.lines.map(({ connections }) => (isActivity ? Math.max(...connections.map((at) => robot.connections[at].passed)) : -Infinity));
    const last = Math.max(...times);
    this.lines.forEach((line, at) => {
      const is = (/** @type {(at: number) => boolean} */ test) => !isActivity && line.connections.some(test);
      show(line, LINE, [is((at) => this.flows(at)), is((at) => robot.awaited.has(at)), times[at] === last && last > -Infinity]);
    });
    this.doing = showDoing(this.states);
  }

  /** Says in a state since when it is active. @param {Item} item */
  say({ since, kind, nodes, path }) {
    if (!since) return;
    const active = nodes.map((at) => robot.nodes[at]).filter((node) => node.active);
    const words = active.length === 0 ? kind : duration(robot.now - Math.min(...active.map((node) => node.since)));
    if (since.textContent === words) return;
    since.textContent = words;
    this.labels.say(path, active.length === 0 ? "" : words);
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

  /** Marks a box. @param {string | null} name */
  mark(name) {
    for (const { element, path } of this.items.values()) element.classList.toggle("is-selected", path === name);
    this.labels.place(this.view.scale, name);
  }

  /** Selects a box, and comes near enough to read it, unless it was clicked here. @param {string | null} name @param {string} [by] */
  select(name, by) {
    this.mark(name);
    const item = this.items.get(name ?? "");
    if (item && item.width > 0 && by !== "picture") this.reveal(item);
  }

  /** Comes near enough to a box to read it, unless it can be read already. @param {Item} item */
  reveal(item) {
    const { scale } = this.view;
    const near = Math.max(scale, item.isFrame ? Math.min(1, this.filling(item)) : 1);
    const isLegible = scale >= READABLE || near <= scale;
    if (isLegible && this.sees(item)) return;
    this.isWhole = false;
    this.centre(item, isLegible ? scale : near);
  }

  /** `true` if all of a box is in the window. @param {import("./labels.js").Box} box */
  sees({ x, y, width, height }) {
    const { view, place } = this;
    const [left, top] = [(x - view.x) * view.scale, (y - view.y) * view.scale];
    return left >= -1 && top >= -1 && left + width * view.scale <= place.clientWidth + 1 && top + height * view.scale <= place.clientHeight + 1;
  }

  /** Pixels per unit with which something fills the window. @param {{width: number, height: number}} of */
  filling({ width, height }) {
    const { clientWidth, clientHeight } = this.place;
    return Math.min((clientWidth - 2 * MARGIN) / width, (clientHeight - 2 * MARGIN) / height);
  }

  /** Shows a box in the middle of the window. @param {{x: number, y: number, width: number, height: number}} box @param {number} scale */
  centre({ x, y, width, height }, scale) {
    const { clientWidth, clientHeight } = this.place;
    this.view = { x: x + width / 2 - clientWidth / scale / 2, y: y + height / 2 - clientHeight / scale / 2, scale };
    this.look();
  }

  /** Keeps a graph that was opened or closed where it was, and all of it in the window. @param {{graph: string, left: number, top: number}} turned */
  keep({ graph, left, top }) {
    const item = this.items.get(graph);
    if (!item || this.isWhole) return;
    const { clientWidth, clientHeight } = this.place;
    const scale = Math.min(this.view.scale, this.filling(item));
    const within = (/** @type {number} */ at, /** @type {number} */ long, /** @type {number} */ all) => Math.max(MARGIN, Math.min(at, all - long * scale - MARGIN));
    const [x, y] = [within(left, item.width, clientWidth), within(top, item.height, clientHeight)];
    this.view = { x: item.x - x / scale, y: item.y - y / scale, scale };
  }

  /** Selects a node and shows it, opens the graphs around it, and leaves the activity for a node that is not part of it. @param {string} name */
  jump(name) {
    const isState = this.graphs.includes(name) || this.states.some((at) => robot.about?.nodes[at].name === name);
    if (this.shown === "activity" && !isState) {
      this.wanted = name;
      ask({ open: { view: "wiring", open: null } });
      return;
    }
    const around = this.graphs.filter((graph) => name.startsWith(`${graph}.`));
    if (around.some((graph) => !this.open.has(graph))) {
      this.wanted = name;
      around.forEach((graph) => this.open.add(graph));
      this.ask();
      return;
    }
    this.wanted = null;
    select(name);
  }

  /** Asks for the picture with the open graphs. */
  ask() {
    ask({ open: { view: this.shown, open: [...this.open] } });
  }

  /** Shows the activity, or the wiring. @param {string} [view] */
  turn(view = this.shown === "activity" ? "wiring" : "activity") {
    ask({ open: { view, open: null } });
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
    this.jump(best.path);
    const { left, bottom } = best.element.getBoundingClientRect();
    tip(this.words(best.element), /** @type {any} */ ({ clientX: left, clientY: bottom - 8 }));
  }

  /** Opens or closes a nested graph. @param {string | null} name */
  toggle(name) {
    const graph = this.graphs.includes(name ?? "") ? name : this.graphs.filter((g) => name?.startsWith(`${g}.`)).sort((a, b) => b.length - a.length)[0];
    if (!graph) return;
    const { view, items } = this;
    const { x, y } = items.get(graph) ?? view;
    this.turned = { graph, left: (x - view.x) * view.scale, top: (y - view.y) * view.scale };
    if (!this.open.delete(graph)) this.open.add(graph);
    this.ask();
  }

  /** Shows all of it. */
  fit() {
    this.isWhole = true;
    this.centre({ x: 0, y: 0, ...this.size }, Math.min(this.filling(this.size), LARGEST));
  }

  /** @param {number} factor @param {MouseEvent} [at] */
  zoom(factor, at) {
    const box = this.place.getBoundingClientRect();
    const [left, top] = at ? [at.clientX - box.left, at.clientY - box.top] : [box.width / 2, box.height / 2];
    this.isWhole = false;
    const { x, y, scale } = this.view;
    const least = Math.min(1, this.filling(this.size) / 2);
    const next = Math.min(Math.max(scale / factor, least), 12);
    this.view = { x: x + left / scale - left / next, y: y + top / scale - top / next, scale: next };
    this.look();
  }

  look() {
    const { x, y, scale } = this.view;
    const { place } = this;
    this.svg?.setAttribute("viewBox", `${x} ${y} ${place.clientWidth / scale} ${place.clientHeight / scale}`);
    place.classList.toggle("is-far", scale < FAR);
    place.classList.toggle("is-small", scale < READABLE);
    place.classList.toggle("has-no-ports", scale < PORTS);
    this.labels.place(scale, robot.selected);
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
    const ran = [
      ...(node.fired > 0 ? [`fired ${node.fired} times, ${node.rate.toFixed(1)}/s`] : []),
      ...(node.taken > 0 ? [`its slots took ${node.taken} tokens`] : []),
    ];
    const fired = ran.length === 0 ? "has not fired" : `${ran.join("; ")}; ${this.ago(node.last)}`;
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
      this.isWhole = false;
      this.view.x -= dx / this.view.scale;
      this.view.y -= dy / this.view.scale;
      drag = { x: event.clientX, y: event.clientY, moved: true };
      this.look();
    });
    place.addEventListener("pointerup", (event) => {
      const path = /** @type {Element} */ (event.target).closest("[data-item]")?.getAttribute("data-item") ?? null;
      if (drag && !drag.moved) {
        const { scale } = this.view;
        const item = this.items.get(path ?? "");
        // What was clicked stays under the pointer.
        if (item && scale < READABLE) this.zoom(scale / Math.max(scale, item.isFrame ? Math.min(1, this.filling(item)) : 1), event);
        select(path || null, "picture");
      }
      drag = null;
    });
    element("does").addEventListener("click", () => this.doing && this.jump(this.doing));
    for (const button of element("views").children) button.addEventListener("click", () => this.turn(button.dataset.view));
    new ResizeObserver(() => (this.isWhole ? this.fit() : this.look())).observe(place);
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
