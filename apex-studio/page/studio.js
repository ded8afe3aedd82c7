// @ts-check
// The page of `apex studio`: the connection, the header and the lists. The other modules draw.
import { ask, choose, connect, element, empty, isTyping, listen, panel, press, state, tip } from "./page.js";
import { Picture } from "./picture.js";
import { Timeline } from "./timeline.js";
import { Params } from "./params.js";
import { Values } from "./values.js";
import { Text } from "./text.js";
import { Why } from "./why.js";
import { Moment } from "./moment.js";
import { completeNames } from "./names.js";

/** @typedef {{name: string, kind: string, docs: string, file: number, line: number, column: number, ports: [string, string, string][]}} AboutNode */
/** @typedef {{from: number, output: string, to: number, input: string, activity: boolean}} Connection */
/** @typedef {{name: string, node: number, schema: {name: string, definition: string} | null}} Channel */
/** @typedef {{name: string, ty: string, unit: string | null, min: number | null, max: number | null}} ParamInfo */
/** @typedef {{name: string, docs: string, files: string[], simulated: boolean, nodes: AboutNode[], connections: Connection[], groups: string[], claims: string[], channels: Channel[], params: ParamInfo[]}} About */
/** @typedef {{active: boolean, fired: number, taken: number, last: number, problems: number, since: number, fresh: boolean, rate: number}} NodeState */

/** What all modules see. */
export const robot = {
  /** @type {About | null} */ about: null,
  /** @type {NodeState[]} */ nodes: [],
  /** `passed` is the time at which activity passed last. @type {{count: number, fresh: boolean, rate: number, passed: number}[]} */ connections: [],
  /** Connections over which a node waits for a token. @type {Set<number>} */ awaited: new Set(),
  now: 0,
  readonly: false,
  /** `true` if this studio asks for neither tokens nor times. */
  looks: false,
  /** The robot beside it, with which it is compared: its shadow, or the robot whose shadow it is. @type {"shadow" | "robot" | null} */
  beside: null,
  /** Times of calls by node, while they are measured. @type {Map<number, {calls: number, total: number, worst: number}> | null} */
  times: null,
  /** @type {string | null} */ selected: null,
};

/** Selects a node or a nested graph by its full name, everywhere. @param {string | null} name @param {string} [by] */
export function select(name, by) {
  robot.selected = name;
  picture.select(name, by);
  text.select(name, by);
  values.select(name);
  timeline.draw();
}

/** @param {number} time */
export const shown = (time) => `${time.toFixed(3)} s`;

export const picture = new Picture(element("picture"));
const timeline = new Timeline(element("timeline"));
const params = new Params(element("params"), element("params-filter"));
const values = new Values(element("values"), element("values-filter"));
const text = new Text(element("text"), picture);
const why = new Why(element("why"), picture, timeline);
const moment = new Moment(timeline);

let paused = false;
/** @type {number | null} */
let speed = 1;
let problems = 0;

/** What the studio tells, by kind. @type {Record<string, (told: any) => void>} */
const tells = {
  about({ about, texts, editable, rebuilds, readonly, looks, travels, repeats, beside }) {
    robot.about = about;
    robot.readonly = readonly;
    robot.looks = looks;
    element("heat").hidden = looks;
    robot.beside = beside;
    element("take").hidden = beside !== "robot" || readonly;
    forget();
    document.title = `${about.name} – Apex Studio`;
    element("name").textContent = about.name;
    element("name").title = about.docs;
    element("pace").hidden = !about.simulated || readonly;
    element("restart").hidden = readonly;
    for (const id of ["back", "goto"]) element(id).hidden = !travels || readonly;
    params.begin();
    values.begin();
    text.begin(texts, editable, rebuilds);
    why.begin();
    if (!repeats) timeline.begin();
    moment.begin();
  },
  back() {
    forget();
    values.begin();
    why.begin();
  },
  checkpoints(why) {
    element("back").title = "before the last reaction (,)" + (why === null ? "" : `. Repeats the run from its start: ${why}`);
    element("back").textContent = why === null ? "Back" : "Back, from the start";
  },
  break(error) {
    element("break").classList.toggle("is-wrong", error !== null);
    element("break").title = error ?? "halts whenever this becomes true: active(a) && !active(b.c)";
    if (error !== null) tip(error, /** @type {any} */ (centre(element("break"))));
    else tip(null);
  },
  picture(told) { picture.show(told); },
  tick(told) { tick(told); },
  written(told) { text.update(told); },
  errors(errors) {
    if (errors !== null) text.say("");
    element("errors").hidden = errors === null;
    element("errors").textContent = errors ?? "";
  },
  problems({ count, problems: all }) { showProblems(count, all); },
  params(all) { params.update(all); },
  times(all) {
    if (robot.times) robot.times = new Map(all.map((/** @type {number[]} */ [node, calls, total, worst]) => [node, { calls, total, worst }]));
    picture.heat();
  },
  why(lines) { why.update(lines); },
  test(result) { moment.tell(result); },
  saved(result) { params.tell(result); },
  tokens(all) { values.update(all); },
  beside(all) { values.updateBeside(all); },
  lanes(lanes) { timeline.show(lanes); },
  robots({ names, shown, studies }) { choose(names, studies, String(shown)); },
  runs({ earlier, last, shown: run }) {
    const choice = element("earlier");
    choice.hidden = earlier.length === 0;
    const name = (/** @type {[number, number]} */ [number, end]) => `run ${number}, until ${shown(end)}`;
    choice.replaceChildren(...earlier.map((/** @type {[number, number]} */ run) => new Option(name(run), String(run[0]))), new Option(`run ${last}`, String(last)));
    choice.value = String(run);
  },
};

/** Forgets everything that the robot has done. */
function forget() {
  const { nodes, connections } = robot.about ?? { nodes: [], connections: [] };
  robot.now = 0;
  if (robot.times) robot.times = new Map();
  robot.nodes = nodes.map(() => ({ active: false, fired: 0, taken: 0, last: 0, problems: 0, since: 0, fresh: false, rate: 0 }));
  robot.connections = connections.map(() => ({ count: 0, fresh: false, rate: 0, passed: -Infinity }));
  rates.length = 0;
  element("problems").replaceChildren();
  problems = 0;
  showActive();
}

/** A place below an element, for a tip. @param {HTMLElement} of */
function centre(of) {
  const { left, bottom } = of.getBoundingClientRect();
  return { clientX: left, clientY: bottom };
}

/** @param {any} told */
function tick(told) {
  const [kind, why] = typeof told.run === "string" ? [told.run, told.run] : Object.entries(told.run)[0];
  const words = /** @type {string} */ (why);
  if (told.silence !== null) state("lost", told.silence);
  else state(kind, kind === "running" && told.paused ? "halted" : words);
  robot.now = told.now;
  paused = told.paused;
  speed = told.speed;
  element("now").textContent = shown(told.now);
  element("pause").textContent = paused ? "Run" : "Halt";
  element("step").disabled = !paused;
  if (document.activeElement !== element("speed")) element("speed").value = speed === null ? "" : String(speed);
  element("lost").hidden = told.lost === 0;
  element("lost").textContent = `${told.lost} messages lost`;
  element("forgotten").hidden = told.forgotten === null;
  element("forgotten").textContent = told.forgotten === null ? "" : `only sums before ${shown(told.forgotten)}`;
  for (const node of robot.nodes) node.fresh = false;
  for (const line of robot.connections) line.fresh = false;
  let changed = false;
  // The program is not there yet.
  if (robot.about === null) return;
  for (const [at, active, since, fired, taken, last, problems] of told.nodes) {
    const node = robot.nodes[at];
    changed ||= node.active !== active;
    Object.assign(node, { active, since, fresh: fired + taken !== node.fired + node.taken, fired, taken, last, problems });
  }
  robot.awaited = new Set(told.awaited);
  for (const [at, count] of told.handled) Object.assign(robot.connections[at], { fresh: true, count });
  for (const [at, passed] of told.passed) robot.connections[at].passed = passed;
  measure();
  if (changed) showActive();
  else showSince();
  picture.update();
  timeline.tick();
}

/** Counts of the last seconds, for rates. @type {{now: number, fired: number[], counts: number[]}[]} */
const rates = [];

/** Updates all rates: per second of the robot's time, over the last two. */
function measure() {
  rates.push({ now: robot.now, fired: robot.nodes.map((node) => node.fired), counts: robot.connections.map((line) => line.count) });
  while (rates.length > 2 && (rates[1].now <= robot.now - 2 || rates.length > 200)) rates.shift();
  const first = rates[0];
  const span = robot.now - first.now;
  if (span <= 0) return;
  robot.nodes.forEach((node, at) => { node.rate = (node.fired - first.fired[at]) / span; });
  robot.connections.forEach((line, at) => { line.rate = (line.count - first.counts[at]) / span; });
}

/** Time in ms at which that was shown last. */
let sinceShown = 0;

/** Lists the active nodes; a click shows one. */
function showActive() {
  const list = element("active");
  const names = robot.nodes.flatMap((node, at) => (node.active ? [at] : []));
  list.replaceChildren(...names.map((at) => {
    const [item, button, since] = ["li", "button", "span"].map((kind) => document.createElement(kind));
    since.className = "since";
    since.dataset.node = String(at);
    button.append(since, robot.about?.nodes[at].name ?? "");
    button.addEventListener("click", () => picture.jump(robot.about?.nodes[at].name ?? ""));
    item.append(button);
    return item;
  }));
  if (names.length === 0) list.append(empty("no node is active"));
  sinceShown = 0;
  showSince();
}

/** Shows since when nodes are active, as often as one can read it. */
function showSince() {
  const now = performance.now();
  if (now - sinceShown < 200 || element("active").closest("[data-panel]").hidden) return;
  sinceShown = now;
  for (const since of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("#active .since"))) {
    since.textContent = `${Math.max(0, robot.now - robot.nodes[Number(since.dataset.node)].since).toFixed(1)} s`;
  }
}

/** @param {number} count @param {{at: number, node: number | null, text: string}[]} all */
function showProblems(count, all) {
  const list = element("problems");
  for (const { at, node, text } of all) {
    const [item, button, time] = ["li", "button", "time"].map((kind) => document.createElement(kind));
    const name = node === null ? null : robot.about?.nodes[node]?.name ?? null;
    time.textContent = `${shown(at)} `;
    button.append(time, name === null ? text : `${name}: ${text}`);
    button.addEventListener("click", () => {
      if (name !== null) picture.jump(name);
      timeline.look(at);
    });
    item.append(button);
    list.prepend(item);
  }
  while (list.children.length > 500) list.lastElementChild.remove();
  problems = count;
  const tab = /** @type {HTMLElement} */ (document.querySelector("[data-tab=problems]"));
  tab.textContent = "Problems";
  const number = document.createElement("span");
  number.className = "count";
  number.textContent = problems > 0 ? String(problems) : "";
  tab.append(number);
}

/** The robot that was asked for last, until the studio answers. @type {number | null} */
let coming = null;

/** Handles a message, except late ones about the robot that was shown before. @param {string} kind @param {any} told */
function hear(kind, told) {
  if (kind === "robots" && told.shown === coming) coming = null;
  if (coming === null) tells[kind]?.(told);
}

/** Shows another robot. @param {number} at */
function look(at) {
  coming = at;
  select(null);
  text.forget();
  picture.forget();
  Object.assign(robot, { about: null, nodes: [], connections: [], awaited: new Set() });
  for (const list of ["active", "problems"]) element(list).replaceChildren();
  element("name").textContent = "Apex Studio";
  ask({ robot: at });
  if (robot.times !== null) ask({ measure: true });
}

/** Shows the share of each node in the computing time, or no longer. */
function heat() {
  if (robot.looks) return;
  robot.times = robot.times ? null : new Map();
  element("heat").setAttribute("aria-pressed", String(robot.times !== null));
  ask({ measure: robot.times !== null });
  picture.heat();
}

function pause() { ask(paused ? { run: { speed } } : "pause"); }

element("pause").addEventListener("click", pause);
element("step").addEventListener("click", () => ask("step"));
element("take").addEventListener("click", () => ask("take"));
element("heat").addEventListener("click", heat);
element("back").addEventListener("click", () => ask("back"));
element("goto").addEventListener("click", () => timeline.go());
completeNames(element("break"), element("names"));
element("break").addEventListener("change", () => ask({ break: element("break").value }));
element("restart").addEventListener("click", () => ask("restart"));
element("robot").addEventListener("change", () => {
  const chosen = element("robot").value;
  if (chosen.startsWith("study")) location.assign(`${chosen}${location.hash}`);
  else look(Number(chosen));
});
element("earlier").addEventListener("change", () => ask({ look: Number(element("earlier").value) }));
element("speed").addEventListener("change", () => {
  const chosen = element("speed").value;
  ask({ run: { speed: chosen === "" ? null : Number(chosen) } });
});

/** Shows one of the panels, and pinned values below the parameters, which they depend on. @param {string} name */
export function show(name) {
  panel(name);
  const [pinned, isBeside] = [element("values").parentElement, name === "params" && values.pinned.size > 0];
  pinned.classList.toggle("beside", isBeside);
  if (isBeside) pinned.hidden = false;
  if (name === "text") text.show();
}
for (const tab of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("[data-tab]"))) {
  tab.addEventListener("click", () => (tab.dataset.tab === "why" ? why.ask() : show(tab.dataset.tab ?? "")));
}

const tabs = listen();

document.addEventListener("keydown", (event) => {
  const target = /** @type {HTMLElement} */ (event.target);
  if (event.key === "s" && (event.ctrlKey || event.metaKey)) {
    event.preventDefault();
    text.save(false);
    return;
  }
  if (event.key === "F8") {
    event.preventDefault();
    show("text");
    text.next();
    return;
  }
  if (isTyping(event)) return;
  /** @type {Record<string, () => void>} */
  const keys = {
    " ": pause,
    ".": () => ask("step"),
    ",": () => ask("back"),
    g: () => timeline.go(),
    h: heat,
    f: () => timeline.follow(),
    w: () => why.ask(),
    a: () => picture.turn(),
    d: () => values.turn(),
    "/": () => /** @type {HTMLElement} */ (document.querySelector("[data-panel]:not([hidden]) input[type=search]") ?? element("lanes-filter")).focus(),
    o: () => picture.toggle(robot.selected),
    Escape: () => select(null),
    "+": () => picture.zoom(0.8),
    "-": () => picture.zoom(1.25),
    0: () => picture.fit(),
    "?": () => element("keys").showModal(),
  };
  press(event, keys, tabs);
});

show("active");
connect("live", hear, () => {
  coming = null;
  ask({ measure: robot.times !== null });
  values.watch();
});
