// @ts-check
// What the robot does, in words: its active states, with the graphs around them and the time since when.
import { element } from "./page.js";
import { robot } from "./studio.js";

/** Number of graphs, and of nodes in each, that are named. */
const MOST = 3;

/** A duration as one says it. @param {number} seconds */
export function duration(seconds) {
  const whole = Math.floor(Math.max(0, seconds));
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  return `${Math.floor(whole / 3600)} h ${Math.floor((whole % 3600) / 60)} min`;
}

/** The graph around a node. @param {string} name */
export const around = (name) => name.slice(0, Math.max(0, name.lastIndexOf(".")));

/** The longest path that is the same for all of these. @param {string[]} paths */
export function common(paths) {
  const [first = "", ...others] = paths;
  const parts = first.split(".");
  const same = parts.findIndex((part, at) => others.some((other) => other.split(".")[at] !== part));
  return parts.slice(0, same < 0 ? parts.length : same).join(".");
}

/** A name without the path before it. @param {string} name @param {string} path */
export const below = (name, path) => (path !== "" && name.startsWith(`${path}.`) ? name.slice(path.length + 1) : name);

/** Words for those of a list that are not named. @param {any[]} all @param {string} between */
const more = (all, between) => (all.length > MOST ? `${between}${all.length - MOST} more` : "");

/** The first names of a list. @param {string[]} names @param {string} between */
const some = (names, between) => names.slice(0, MOST).join(between) + more(names, between);

/** The active states, by the graphs around them. @param {number[]} states numbers of all states */
function doing(states) {
  const name = (/** @type {number} */ at) => robot.about?.nodes[at].name ?? "";
  const path = common(states.map((at) => around(name(at))));
  /** @type {Map<string, {graph: string[], names: string[], since: number, node: number}>} */
  const groups = new Map();
  for (const at of states.filter((at) => robot.nodes[at].active)) {
    const { since } = robot.nodes[at];
    const [own, within] = [name(at).split(".").pop() ?? "", around(name(at))];
    const group = groups.get(within) ?? { graph: within === path ? [] : below(within, path).split("."), names: [], since, node: at };
    group.names.push(own);
    // The time is that of the last change.
    if (since >= group.since) Object.assign(group, { since, node: at });
    groups.set(within, group);
  }
  return [...groups.values()];
}

/** Shows what the robot does. Returns the node that it has begun to do last. @param {number[]} states */
export function showDoing(states) {
  const place = element("does");
  const groups = doing(states);
  // What has changed last is named if all is too much.
  const newest = [...groups].sort((a, b) => b.since - a.since).slice(0, MOST);
  const parts = groups.filter((group) => newest.includes(group)).map(({ graph, names, since }) => `${[...graph, some(names, " + ")].join(" > ")}, ${duration(robot.now - since)}`);
  const words = parts.length === 0 ? "does nothing" : `does: ${parts.join("; ")}${more(groups, "; ")}`;
  place.hidden = states.length === 0;
  if (place.textContent !== words) place.textContent = words;
  const last = groups.reduce((last, group) => (last === null || group.since > last.since ? group : last), /** @type {typeof groups[0] | null} */ (null));
  return last === null ? null : robot.about?.nodes[last.node].name ?? null;
}
