// @ts-check
// The page of a study: the header, the candidate under the pointer, and the result. The other modules draw.
import { ask, choose, connect, element, isTyping, listen, make, panel, press, state, tip } from "./page.js";
import { Candidates } from "./candidates.js";
import { Course } from "./course.js";

/** @typedef {{name: string, unit: string, low: number, high: number, wide: boolean, default: number}} Parameter */
/** @typedef {{name: string, unit: string, maximise: boolean, summary: string}} Goal */
/** @typedef {{name: string, journal: string, parameters: Parameter[], goals: Goal[], seeds: number[], searches: number, candidates: number}} About */
/** @typedef {{number: number, ended: number, known: number, best: number | null, improvements: [number, number][]}} Search */
/** @typedef {{finished: boolean, age: number | null, left: number | null, lines: number, runs: number, saved: number, failed: number, searches: Search[], best: [number, number] | null, defaults: (number | null)[] | null, ranges: ([number, number] | null)[]}} State */
/** @typedef {{number: number, fate: "running" | "complete" | "stopped" | "failed", values: number[], goals: (number | null)[], runs: number, cells: (number | null | false)[]}} Lane */

/** What all modules see. */
export const study = {
  /** @type {About | null} */ about: null,
  /** @type {State | null} */ state: null,
  /** Number of the search whose candidates are shown. */
  search: 0,
  /** Number of the goal whose values are shown. */
  goal: 0,
  /** Number of the selected candidate; without one the best is shown. @type {number | null} */ selected: null,
};

/** Number with six digits; failures have none. @param {number | null | undefined} value @param {string} [unit] */
export function number(value, unit) {
  if (value === null || value === undefined) return "failed";
  return [String(Number(value.toPrecision(6))), unit].filter(Boolean).join(" ");
}

/** The search that is shown. */
export const search = () => study.state?.searches.find(({ number }) => number === study.search);

/** Number of the candidate that is shown without a pointer. */
const chosen = () => study.selected ?? search()?.best ?? null;

const candidates = new Candidates(element("candidates"));
const course = new Course(element("course"));
/** Candidate under the pointer. @type {Lane | null} */ let hovered = null;
/** The chosen candidate. @type {{lane: Lane, params: string} | null} */ let kept = null;
/** What the panel shows, so that it is written only if it changes. */ let written = "";

/** What the studio tells, by kind. @type {Record<string, (told: any) => void>} */
const tells = {
  studies({ names, shown, robots }) { choose(robots, names, `study?${shown}`); },
  study(about) {
    Object.assign(study, { about, state: null, search: 0, goal: 0, selected: null });
    [hovered, kept, written] = [null, null, ""];
    document.title = `${about.name} – Apex Studio`;
    element("name").textContent = about.name;
    element("name").title = about.journal;
    const goal = (/** @type {Goal} */ { name, maximise }) => `${maximise ? "maximise" : "minimise"} ${name}`;
    fill("goal", about.goals.map((/** @type {Goal} */ of, /** @type {number} */ at) => [goal(of), at]));
    element("result").replaceChildren(make("p", "empty", "The study has not ended yet."));
    candidates.begin();
    show();
  },
  errors(error) {
    element("errors").hidden = error === null;
    element("errors").textContent = error ?? "";
    if (study.state !== null) return;
    if (error === null) state("idle", "the journal has no complete line yet");
    else state("lost", "the journal cannot be read");
  },
  state(told) {
    const grown = told.lines !== study.state?.lines;
    study.state = told;
    if (!search() && told.searches.length > 0) study.search = told.searches[0].number;
    head(told);
    if (grown) {
      fill("search", told.searches.map((/** @type {Search} */ { number }) => [`search ${number + 1} of ${study.about?.searches}`, number]));
      element("search").value = String(study.search);
      candidates.grow();
      course.draw();
      refresh();
    }
  },
  lanes(lanes) { candidates.show(lanes); },
  candidate(told) {
    if (told.search !== study.search || told.lane.number !== chosen()) return;
    kept = told;
    show();
  },
  result(outcome) { result(outcome); },
};

/** Fills a choice, which is hidden if there is none. @param {string} id @param {[string, number][]} options */
function fill(id, options) {
  const choice = element(id);
  choice.hidden = options.length < 2;
  const names = (/** @type {string[]} */ all) => all.join("\n");
  if (names([...choice.options].map(({ text }) => text)) === names(options.map(([name]) => name))) return;
  choice.replaceChildren(...options.map(([name, value]) => new Option(name, String(value))));
}

/** @param {number} seconds */
function duration(seconds) {
  if (seconds < 100) return `${Math.ceil(seconds)} s`;
  return seconds < 6000 ? `${Math.ceil(seconds / 60)} min` : `${(seconds / 3600).toFixed(1)} h`;
}

/** Fills the header. @param {State} told */
function head(told) {
  const about = /** @type {About} */ (study.about);
  const isYoung = told.age !== null && told.age < 60;
  if (!element("errors").hidden) state("lost", "the journal has an error");
  else if (told.finished) state("ended", "finished");
  else if (told.age === null) state("idle", "reading the journal");
  else state(isYoung ? "running" : "idle", isYoung ? "running" : `no run has ended for ${duration(told.age)}`);
  const ended = told.searches.reduce((sum, { ended }) => sum + ended, 0);
  element("progress").textContent = `${ended} of ${about.candidates * about.searches} candidates`;
  element("left").textContent = told.left === null || !isYoung ? "" : `${duration(told.left)} left`;
  const goal = about.goals[study.goal];
  const best = told.searches.find(({ number }) => number === told.best?.[0])?.improvements.at(-1)?.[1];
  const defaults = told.defaults === null ? "" : `, defaults ${number(told.defaults[study.goal], goal.unit)}`;
  element("value").textContent = best === undefined ? "no candidate is complete yet" : `best ${course.value(best)}${defaults}`;
  const saved = told.runs + told.saved > 0 ? (100 * told.saved) / (told.runs + told.saved) : 0;
  element("runs").textContent = `${told.runs} runs, ${told.failed} failed; ${saved.toFixed(1)} % were not necessary`;
  const [good, bad] = told.ranges[study.goal] ?? [null, null];
  const colors = make("span", "colors");
  element("scale").replaceChildren(...(good === null ? [] : [number(good), colors, number(bad, goal.unit)]));
}

/** Asks for the candidate that is shown without a pointer. */
function refresh() {
  const number = chosen();
  if (number === null) kept = null;
  else ask({ candidate: { search: study.search, number } });
  show();
}

/** Selects a candidate, or none. @param {number | null} number */
export function select(number) {
  study.selected = number;
  // A pointer that rests somewhere hides nothing that is chosen by a key.
  hovered = null;
  element("copied").textContent = "";
  refresh();
  candidates.draw();
  course.draw();
}

/** Shows the candidate under the pointer, or the chosen one again. @param {Lane | null} lane */
export function hover(lane) {
  if (lane?.number === hovered?.number) return;
  hovered = lane;
  show();
}

/** Fills the panel of the candidate. */
function show() {
  const lane = hovered ?? kept?.lane ?? null;
  const now = JSON.stringify([lane && { ...lane, cells: [] }, kept?.params, study.search, study.state?.defaults, lane && lane.number === search()?.best]);
  if (now === written) return;
  written = now;
  const [place, values] = [element("candidate"), element("values")];
  const isKept = lane !== null && lane.number === kept?.lane.number;
  element("copy").hidden = !isKept;
  element("toml").textContent = isKept ? kept?.params ?? "" : "";
  if (lane === null || study.about === null) {
    place.replaceChildren(make("p", "empty", "There is no complete candidate yet."));
    values.replaceChildren();
    return;
  }
  place.replaceChildren(make("h2", "", title(lane)), make("p", `fate ${lane.fate}`, fate(lane)), goals(lane));
  values.replaceChildren(...study.about.parameters.map((parameter, at) => row(parameter, lane.values[at])));
}

/** @param {Lane} lane */
function title({ number }) {
  const of = (study.about?.searches ?? 1) > 1 ? ` of search ${study.search + 1}` : "";
  return `Candidate ${number}${of}${number === search()?.best ? ", the best" : ""}`;
}

/** @param {Lane} lane */
function fate({ fate, runs }) {
  const of = `${runs} of ${study.about?.seeds.length} runs`;
  const words = {
    running: "more may follow",
    complete: "complete",
    stopped: "it cannot win any more, so that the others were not necessary",
    failed: "a run, or a test, has failed",
  };
  return `${of}: ${words[fate]}`;
}

/** Line of a table, whose first word is a heading, or all of them. @param {string[]} words @param {boolean} [areHeadings] */
function line(words, areHeadings = false) {
  const row = make("tr", "");
  row.append(...words.map((word, column) => make(areHeadings || column === 0 ? "th" : "td", "", word)));
  return row;
}

/** Name of a goal or parameter, with its unit. @param {{name: string, unit: string}} of */
const label = ({ name, unit }) => `${name}${unit === "" ? "" : ` [${unit}]`}`;

/** Values by goal, against those of the defaults. @param {Lane} lane */
function goals(lane) {
  const table = make("table", "goals");
  table.append(line(["", "value", "defaults"]));
  study.about?.goals.forEach((goal, at) => {
    const { maximise, summary } = goal;
    const sign = lane.fate === "complete" || lane.fate === "failed" ? "" : maximise ? "≤ " : "≥ ";
    const value = lane.goals[at];
    const shown = lane.fate === "failed" ? "failed" : value === null ? "–" : sign + number(value);
    const defaults = study.state?.defaults ?? null;
    table.append(line([`${label(goal)} ${summary}`, shown, defaults === null ? "–" : number(defaults[at])]));
  });
  return table;
}

/** Place of a value in the range of its parameter, in percent. @param {Parameter} parameter @param {number} value */
function place({ low, high, wide }, value) {
  const share = wide ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return 100 * Math.min(Math.max(Number.isFinite(share) ? share : 0.5, 0), 1);
}

/** A parameter with its value, against the default. @param {Parameter} parameter @param {number} value */
function row(parameter, value) {
  const { name, unit, low, high, wide } = parameter;
  const row = make("div", "param");
  row.dataset.param = name;
  row.classList.toggle("is-changed", value !== parameter.default);
  const line = make("div", "row");
  line.append(make("span", "number", number(value)), make("span", "unit", unit), make("span", "range", `default ${number(parameter.default)}`));
  const axis = make("div", "axis");
  axis.title = `${number(low)} to ${number(high)}${wide ? ", logarithmic" : ""}`;
  for (const [kind, at] of /** @type {[string, number][]} */ ([["default", parameter.default], ["value", value]])) {
    const mark = make("span", kind);
    mark.style.left = `${place(parameter, at)}%`;
    axis.append(mark);
  }
  row.append(make("div", "name", name), line, axis);
  return row;
}

/** Fills the panel of the result. @param {{goals: (number | null)[][], lost: (number | null)[], cost: string, warning: string | null, better: boolean}} outcome */
function result({ goals, lost, cost, warning, better }) {
  const about = /** @type {About} */ (study.about);
  const table = (/** @type {string[][]} */ lines) => {
    const made = make("table", "goals");
    made.append(...lines.map((words, at) => line(words, at === 0)));
    return made;
  };
  const scores = about.goals.map((goal, at) => [`${label(goal)} ${goal.summary}`, ...goals[at].map((value) => number(value))]);
  const parts = about.parameters.map((parameter, at) => [label(parameter), number(lost[at])]);
  element("result").replaceChildren(
    ...(warning === null ? [] : [make("p", "is-bad", `Warning: ${warning}.`)]),
    ...(better ? [] : [make("p", "is-bad", "No candidate is better than the defaults.")]),
    table([["", "defaults", "tuned", "defaults, held out", "tuned, held out"], ...scores]),
    table([["", "lost with the default"], ...parts]),
    make("p", "", cost),
  );
}

/** Copies the values of the chosen candidate. */
async function copy() {
  if (kept === null) return;
  const said = element("copied");
  try {
    await navigator.clipboard.writeText(kept.params);
    said.textContent = "copied";
  } catch {
    // Without a secure connection a page cannot copy by itself.
    getSelection()?.selectAllChildren(element("toml"));
    said.textContent = "press Ctrl-C";
  }
}

const tabs = listen();
for (const tab of tabs) tab.addEventListener("click", () => panel(tab.dataset.tab ?? ""));
element("copy").addEventListener("click", copy);
element("robot").addEventListener("change", () => {
  const choice = element("robot").value;
  location.assign(choice.startsWith("study") ? `${choice}${location.hash}` : `/${location.hash}`);
});
for (const id of ["search", "goal"]) {
  element(id).addEventListener("change", () => {
    Object.assign(study, { [id]: Number(element(id).value), selected: id === "search" ? null : study.selected });
    element(id).blur();
    candidates.begin();
    if (study.state) head(study.state);
    select(study.selected);
  });
}

document.addEventListener("keydown", (event) => {
  if (isTyping(event)) return;
  /** @type {Record<string, () => void>} */
  const keys = {
    b: () => candidates.look(search()?.best ?? null),
    c: copy,
    f: () => candidates.follow(),
    o: () => candidates.reorder(),
    Escape: () => select(null),
    "?": () => element("keys").showModal(),
  };
  press(event, keys, tabs);
});

panel("candidate");
tip(null);
connect("follow", (kind, told) => tells[kind]?.(told), () => {
  const number = Number(location.search.slice(1));
  if (number > 0) ask({ study: number });
});
