// @ts-check
// Tokens of ports: numbers as plots, what has a place in the plane or in space, images, all else as text.
import { hasPlace, isMeasured, isPose, read } from "./drawn.js";
import { Space } from "./space.js";
import { World, drawImage } from "./world.js";
import { ask, empty } from "./page.js";
import { robot } from "./studio.js";

const MAX = 4000;

export class Values {
  /** @param {HTMLElement} place @param {HTMLInputElement} filter */
  constructor(place, filter) {
    this.place = place;
    this.filter = filter;
    /** Pinned channels, by name: they survive a restart. @type {Set<string>} */ this.pinned = new Set();
    /** @type {Map<number, {time: number, text: string}[]>} */ this.tokens = new Map();
    /** Those of the robot beside this one. @type {Map<number, {time: number, text: string}[]>} */ this.beside = new Map();
    /** @type {Map<number, HTMLElement>} */ this.rows = new Map();
    /** The newest tokens that are messages. @type {Map<number, any>} */ this.messages = new Map();
    /** Names of the channels with the poses from which others are seen. @type {Map<string, string>} */ this.seenFrom = new Map();
    /** Those that the graph tells. @type {Map<string, string>} */ this.taken = new Map();
    this.world = new World(/** @type {HTMLCanvasElement} */ (document.getElementById("world")));
    this.space = new Space(/** @type {HTMLCanvasElement} */ (document.getElementById("space")));
    /** Shows space instead of the plane. */
    this.third = /** @type {HTMLButtonElement} */ (document.getElementById("third"));
    this.third.addEventListener("click", () => this.turn());
    filter.addEventListener("input", () => this.list());
  }

  begin() {
    this.tokens.clear();
    this.beside.clear();
    this.messages.clear();
    this.taken.clear();
    this.list();
    this.watch();
  }

  /** @param {string | null} _name */
  select(_name) { this.list(); }

  /** Channels that can be shown: pinned ones, those of the selected node, and those that the filter finds. */
  channels() {
    const words = this.filter.value.toLowerCase();
    return (robot.about?.channels ?? []).flatMap(({ name, node, schema }, at) => {
      const owner = robot.about?.nodes[node]?.name ?? "";
      const near = robot.selected !== null && (owner === robot.selected || owner.startsWith(`${robot.selected}.`));
      const found = words !== "" ? name.toLowerCase().includes(words) : near || robot.selected === null;
      return schema && (this.pinned.has(name) || found) ? [{ name, at }] : [];
    }).sort((a, b) => Number(this.pinned.has(b.name)) - Number(this.pinned.has(a.name))).slice(0, 300);
  }

  list() {
    this.rows.clear();
    const channels = this.channels();
    this.place.replaceChildren(...channels.map(({ name, at }) => {
      const [row, label, box] = [document.createElement("div"), document.createElement("label"), document.createElement("input")];
      row.className = "value";
      row.dataset.channel = name;
      box.type = "checkbox";
      box.checked = this.pinned.has(name);
      box.disabled = robot.looks;
      if (robot.looks) box.title = "this studio may only look, and asks the robot for no tokens";
      box.addEventListener("change", () => {
        if (box.checked) this.pinned.add(name);
        else this.pinned.delete(name);
        this.tokens.delete(at);
        this.messages.delete(at);
        this.list();
        this.watch();
      });
      label.append(box, ` ${name}`);
      row.append(...this.from(name, at), label);
      // The token has its place before it is there: nothing moves under the mouse.
      if (box.checked) row.append(Object.assign(document.createElement("pre"), { textContent: "no token yet" }));
      this.rows.set(at, row);
      return row;
    }));
    if (channels.length === 0) this.place.append(empty("no port whose tokens can be shown"));
    for (const at of this.rows.keys()) this.draw(at);
    this.drawWorld();
  }

  /** A choice of the pose from which the tokens of a pinned channel are seen. @param {string} name @param {number} at */
  from(name, at) {
    const schema = robot.about?.channels[at].schema?.name ?? "";
    const poses = (robot.about?.channels ?? []).filter((channel) => channel.name !== name && isPose(channel.schema?.name ?? ""));
    if (!this.pinned.has(name) || !hasPlace(schema) || poses.length === 0) return [];
    const choice = document.createElement("select");
    choice.title = "the pose from which it is seen";
    for (const pose of ["", ...poses.map((channel) => channel.name)]) choice.append(new Option(pose === "" ? "seen from …" : pose, pose));
    choice.value = this.pose(name);
    choice.addEventListener("change", () => {
      this.seenFrom.set(name, choice.value);
      this.watch();
      this.drawWorld();
    });
    return [choice];
  }

  /** The channel with the pose from which a channel is seen: the chosen one, or the one that the graph tells. @param {string} name */
  pose(name) {
    if (!this.taken.has(name)) this.taken.set(name, takenAt(name) ?? "");
    return this.seenFrom.get(name) ?? this.taken.get(name) ?? "";
  }

  /** Shows space instead of the plane, or the other way round. */
  turn() {
    if (this.third.hidden || this.third.disabled) return;
    this.third.setAttribute("aria-pressed", String(!this.inSpace()));
    this.drawWorld();
  }

  inSpace() { return this.third.getAttribute("aria-pressed") === "true"; }

  /** Draws all pinned tokens with a place. What they are drawn on is there before they are. */
  drawWorld() {
    const channels = robot.about?.channels ?? [];
    const isThere = channels.some(({ name, schema }) => schema && this.pinned.has(name) && hasPlace(schema.name));
    const message = (/** @type {string | undefined} */ name) => this.messages.get(channels.findIndex((channel) => channel.name === name));
    const tokens = [...this.messages].flatMap(([at, message_]) => {
      const { name, schema } = channels[at];
      return schema && this.pinned.has(name) && hasPlace(schema.name) ? [{ schema: schema.name, message: message_, from: message(this.pose(name)) }] : [];
    });
    // Maps are below everything else.
    tokens.sort((a, b) => Number(b.schema.endsWith("Grid")) - Number(a.schema.endsWith("Grid")));
    this.third.hidden = !isThere;
    for (const [view, isShown] of /** @type {[World | Space, boolean][]} */ ([[this.world, !this.inSpace()], [this.space, this.inSpace()]])) {
      view.canvas.hidden = !isThere || !isShown;
      Object.assign(view.canvas.dataset, { drawn: tokens.length, from: tokens.filter(({ from }) => from).length });
      if (!view.canvas.hidden) view.draw(tokens);
    }
    if (this.inSpace() && this.space.painter === null) this.hasNoSpace();
  }

  /** The browser cannot draw in space: back to the plane. */
  hasNoSpace() {
    this.third.setAttribute("aria-pressed", "false");
    this.third.disabled = true;
    this.third.title = "this browser has no WebGL, which draws in space";
    this.drawWorld();
  }

  /** Tells the studio which tokens are wanted: of pinned channels, and of the poses from which these are seen. */
  watch() {
    const channels = robot.about?.channels ?? [];
    const poses = new Set([...this.pinned].map((name) => this.pose(name)));
    ask({ watch: channels.flatMap(({ name }, at) => (this.pinned.has(name) || poses.has(name) ? [at] : [])) });
  }

  /** @param {Record<string, {texts: [number, string][]}>} all */
  updateBeside(all) {
    for (const [channel, { texts }] of Object.entries(all)) {
      keep(this.beside, Number(channel), texts);
      this.draw(Number(channel));
    }
  }

  /** @param {Record<string, {texts: [number, string][], bytes: string}>} all */
  update(all) {
    for (const [channel, { texts, bytes }] of Object.entries(all)) {
      const at = Number(channel);
      keep(this.tokens, at, texts);
      const definition = robot.about?.channels[at]?.schema?.definition ?? "";
      const message = bytes === "" || definition === "" ? null : read(definition, Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0)));
      if (message) this.messages.set(at, message);
      this.draw(at);
    }
    this.drawWorld();
  }

  /** @param {number} at */
  draw(at) {
    const row = this.rows.get(at);
    const tokens = this.tokens.get(at);
    if (!row || !tokens || tokens.length === 0) return;
    const last = tokens[tokens.length - 1];
    const text = row.querySelector("pre");
    if (!text) return;
    const own = view(this.messages.get(at));
    text.hidden = own !== null;
    text.textContent = last.text;
    if (own !== null) return this.own(row, own);
    const schema = robot.about?.channels[at].schema?.name ?? "";
    if (schema === "sensor_msgs/msg/Image" && this.messages.has(at)) this.image(row, this.messages.get(at));
    const numbers = finite(tokens);
    if (numbers.length > 1 && Number.isFinite(Number(last.text))) this.plot(row, numbers, finite(this.beside.get(at) ?? []));
  }

  /** Shows the view that a node brings. An image runs no scripts, and loads nothing. @param {HTMLElement} row @param {string} svg */
  own(row, svg) {
    let image = row.querySelector("img");
    if (!image) {
      image = document.createElement("img");
      image.alt = `view of ${row.dataset.channel}`;
      row.append(image);
    }
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  }

  /** @param {HTMLElement} row @param {any} message */
  image(row, message) {
    let canvas = row.querySelector("canvas");
    if (!canvas) {
      canvas = document.createElement("canvas");
      canvas.className = "image";
      row.append(canvas);
    }
    drawImage(canvas, message);
  }

  /** @param {HTMLElement} row @param {{time: number, value: number}[]} numbers @param {{time: number, value: number}[]} beside */
  plot(row, numbers, beside) {
    let canvas = row.querySelector("canvas");
    if (!canvas) {
      canvas = document.createElement("canvas");
      row.append(canvas);
    }
    const style = getComputedStyle(document.documentElement);
    const scale = devicePixelRatio;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = width * scale;
    canvas.height = height * scale;
    const c = canvas.getContext("2d");
    if (!c) return;
    c.scale(scale, scale);
    const end = numbers[numbers.length - 1].time;
    const start = Math.max(numbers[0].time, end - 30);
    const [seen, other] = [numbers, beside].map((all) => all.filter(({ time }) => time >= start && time <= end));
    const all = [...seen, ...other].map((n) => n.value);
    const [low, high] = [Math.min(...all), Math.max(...all)];
    row.dataset.beside = String(other.length);
    const x = (/** @type {number} */ time) => ((time - start) / Math.max(1e-9, end - start)) * (width - 4) + 2;
    const y = (/** @type {number} */ value) => height - 12 - ((value - low) / (high - low || 1)) * (height - 24);
    for (const [curve, color] of /** @type {const} */ ([[other, "--soft"], [seen, "--fire"]])) {
      c.strokeStyle = style.getPropertyValue(color);
      c.lineWidth = 1.5;
      c.beginPath();
      for (const { time, value } of curve) c.lineTo(x(time), y(value));
      c.stroke();
    }
    c.fillStyle = style.getPropertyValue("--soft");
    c.font = "10px system-ui, sans-serif";
    c.fillText(String(high), 2, 9);
    c.fillText(String(low), 2, height - 2);
  }
}

/** The channel with the pose at which the tokens of a channel were taken, as far as the graph tells: a pose that its node
 * takes, or that another node takes together with them. @param {string} name @returns {string | null} */
function takenAt(name) {
  const { channels = [], connections = [], nodes = [] } = robot.about ?? {};
  const channel = channels.find((channel) => channel.name === name);
  if (!channel || !isMeasured(channel.schema?.name ?? "")) return null;
  const isInserted = (/** @type {number} */ node) => ["relay", "probe"].includes(nodes[node].kind);
  /** The nodes behind a connection, over those of the compiler. @type {(to: number, depth?: number) => number[]} */
  const behind = (to, depth = 0) => (isInserted(to) && depth < 8 ? connections.filter(({ from }) => from === to).flatMap((next) => behind(next.to, depth + 1)) : [to]);
  /** The poses that a node takes. @param {number} node */
  const poses = (node) => channels.filter((pose) => isPose(pose.schema?.name ?? "") &&
    connections.some(({ from, output, to }) => from === pose.node && pose.name === `${nodes[from].name}.${output}` && behind(to).includes(node)));
  const takers = connections.filter(({ from, output }) => from === channel.node && name === `${nodes[from].name}.${output}`).flatMap(({ to }) => behind(to));
  return [channel.node, ...takers].flatMap(poses)[0]?.name ?? null;
}

/** Keeps tokens of a channel. @param {Map<number, {time: number, text: string}[]>} all @param {number} at @param {[number, string][]} texts */
function keep(all, at, texts) {
  const kept = all.get(at) ?? [];
  kept.push(...texts.map(([time, text]) => ({ time, text })));
  all.set(at, kept.slice(-MAX));
}

/** Tokens that are numbers. @param {{time: number, text: string}[]} tokens */
const finite = (tokens) => tokens.map(({ time, text }) => ({ time, value: Number(text) })).filter(({ value }) => Number.isFinite(value));

/** The drawing in a token that is one: a text with SVG. @param {any} message @returns {string | null} */
const view = (message) => (typeof message?.data === "string" && message.data.startsWith("<svg") ? message.data : null);
