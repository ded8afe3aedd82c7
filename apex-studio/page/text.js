// @ts-check
// The source files: their texts, which node each line belongs to, and what is saved.
import { Area } from "./area.js";
import { ask, element } from "./page.js";
import { robot, select } from "./studio.js";

/** @typedef {{text: string, disk: string, built: string, version: number, pieces: [number, number][], found: import("./area.js").Found[], asked: boolean, saving?: string}} File */

export class Text {
  /** @param {HTMLElement} place @param {import("./picture.js").Picture} picture */
  constructor(place, picture) {
    this.place = place;
    this.picture = picture;
    /** @type {File[]} */ this.files = [];
    /** @type {string[]} */ this.names = [];
    /** @type {boolean[]} */ this.editable = [];
    this.rebuilds = false;
    this.shown = 0;
    this.area = new Area(element("text-area"), {
      changed: (text) => this.changed(text),
      moved: (line) => this.selectNode(line),
      place: (line, column) => [this.shown, line, column],
    });
    element("text-file").addEventListener("change", () => this.open(Number(element("text-file").value)));
    element("text-save").addEventListener("click", () => this.save(false));
    element("text-over").addEventListener("click", () => this.save(true));
    element("text-theirs").addEventListener("click", () => this.takeTheirs());
    element("text-found").addEventListener("click", () => this.next());
  }

  /** Begins with the texts of a robot. @param {string[]} texts @param {boolean[]} editable @param {boolean} rebuilds */
  begin(texts, editable, rebuilds) {
    const names = robot.about?.files ?? [];
    const before = new Map(this.names.map((name, at) => [name, this.files[at]]));
    this.files = texts.map((text, at) => {
      const old = before.get(names[at]);
      // What was typed and not saved yet stays.
      const own = old && old.text !== old.disk ? old.text : text;
      return { text: own, disk: text, built: text, version: (old?.version ?? 0) + 1, pieces: [], found: old?.text === own ? old.found : [], asked: false };
    });
    this.names = names;
    this.editable = editable;
    this.rebuilds = rebuilds;
    const choice = element("text-file");
    const short = (/** @type {string} */ name) => name.split("/").pop() ?? name;
    const isOnly = (/** @type {string} */ name) => names.filter((other) => short(other) === short(name)).length === 1;
    choice.replaceChildren(...names.map((name, at) => new Option(isOnly(name) ? short(name) : name, String(at))));
    choice.title = names.join("\n");
    choice.disabled = names.length < 2;
    this.open(Math.min(this.shown, Math.max(0, names.length - 1)), false);
    this.say(names.length === 0 || texts.every((text) => text === "") ? "the studio has no text of this robot: start it with the file" : "");
  }

  /** Forgets the texts of a robot. */
  forget() {
    this.names = [];
    this.files = [];
    this.shown = 0;
    this.area.show("", true, true);
  }

  get file() { return this.files[this.shown]; }

  /** Shows a file. @param {number} at */
  open(at, top = true) {
    this.shown = at;
    element("text-file").value = String(at);
    const { file } = this;
    if (!file) return;
    this.area.show(file.text, robot.readonly || !this.editable[at], top);
    if (!this.place.hidden) this.ask();
    this.area.paint(file.pieces, file.found);
    this.marks();
  }

  /** The panel has become visible. */
  show() { this.ask(); }

  /** Asks for the colours of the shown file, and for its errors. */
  ask() {
    const { file } = this;
    if (!file || file.asked) return;
    file.asked = true;
    ask({ edit: { file: this.shown, version: file.version, text: file.text } });
  }

  /** The text was changed here. @param {string} text */
  changed(text) {
    const { file } = this;
    file.text = text;
    file.version += 1;
    file.asked = true;
    ask({ edit: { file: this.shown, version: file.version, text } });
    this.state();
  }

  /** What the studio tells about files. @param {any} told */
  update(told) {
    const [kind, what] = /** @type {[string, any]} */ (Object.entries(told)[0]);
    const file = this.files[what.file];
    if (kind === "paint" && file?.version === what.version) {
      file.pieces = what.pieces;
      if (what.file === this.shown) this.area.paint(file.pieces, file.found);
    } else if (kind === "found" && file) {
      file.found = what.found;
      if (what.file === this.shown) this.area.paint(file.pieces, file.found);
      this.marks();
    } else if (kind === "hover") this.area.hover(what.place, what.text);
    else if (kind === "completions") this.area.complete(what.place, what.items);
    else if (kind === "kept") this.kept(what);
    else if (kind === "disk") for (const [at, text] of what) this.onDisk(at, text);
  }

  /** A file has changed on the disk. @param {number} at @param {string} text */
  onDisk(at, text) {
    const file = this.files[at];
    if (!file) return;
    const isOwn = file.text !== file.disk;
    file.disk = text;
    if (!isOwn) this.take(at, text);
    this.state();
  }

  /** Takes a text from the disk. @param {number} at @param {string} text */
  take(at, text) {
    const file = this.files[at];
    Object.assign(file, { text, version: file.version + 1, pieces: [], asked: false });
    if (at !== this.shown) return;
    this.area.show(text, robot.readonly || !this.editable[at], false);
    if (!this.place.hidden) this.ask();
  }

  takeTheirs() {
    this.take(this.shown, this.file.disk);
    this.conflict(false);
    this.state();
  }

  /** Saves the shown text. @param {boolean} over */
  save(over) {
    const { file } = this;
    if (!file || robot.readonly || !this.editable[this.shown]) return;
    file.saving = file.text;
    ask({ keep: { file: this.shown, text: file.text, over } });
  }

  /** @param {{file: number, error: string | null, changed: boolean}} told */
  kept({ file: at, error, changed }) {
    const file = this.files[at];
    if (!file) return;
    if (error === null) {
      file.disk = file.saving ?? file.text;
      this.conflict(false);
      this.say(this.rebuilds ? "saved; the robot is built" : "saved");
    } else {
      this.conflict(changed);
      this.say(error, true);
    }
    this.state();
  }

  /** Offers what can be done if others have saved, too. @param {boolean} is */
  conflict(is) {
    for (const id of ["text-over", "text-theirs"]) element(id).hidden = !is;
  }

  /** @param {string} words */
  say(words, bad = false) {
    element("text-said").textContent = words;
    element("text-said").classList.toggle("is-bad", bad);
  }

  /** Shows whether there is something to save, and the number of errors. */
  state() {
    const { file } = this;
    if (!file) return;
    const isOwn = file.text !== file.disk;
    element("text-save").hidden = robot.readonly || !this.editable[this.shown];
    element("text-save").disabled = !isOwn;
    element("text-save").classList.toggle("is-own", isOwn);
    const errors = file.found.filter((found) => found.is_error).length;
    const rest = file.found.length - errors;
    const words = [[errors, "error"], [rest, "warning"]].flatMap(([count, word]) => (count ? [`${count} ${word}${count === 1 ? "" : "s"}`] : []));
    element("text-found").hidden = words.length === 0;
    element("text-found").textContent = words.join(", ");
    element("text-found").classList.toggle("is-bad", errors > 0);
    const own = this.files.filter((file) => file.text !== file.disk).length;
    const tab = /** @type {HTMLElement} */ (document.querySelector("[data-tab=text]"));
    tab.classList.toggle("is-own", own > 0);
  }

  /** Lays all errors over the picture. */
  marks() {
    const found = this.files.flatMap((file) => file.found).filter((found) => found.is_error);
    this.picture.wrong(found.flatMap(({ text, concerns }) => concerns.map((concern) => ({ ...concern, text }))));
    this.state();
  }

  /** Goes to the next error or warning. */
  next() {
    const { file } = this;
    const places = file.found.map((found) => found.from).sort(([a, b], [c, d]) => a - c || b - d);
    const [line, column] = this.area.caret();
    const next = places.find(([l, c]) => l > line || (l === line && c > column)) ?? places[0];
    if (next) this.area.go(next[0], next[1]);
  }

  /** Line of the running robot for one of the shown text, or the other way round; both from 0. @param {number} line */
  other(line, toBuilt = true) {
    const [from, to] = toBuilt ? [this.file.text, this.file.built] : [this.file.built, this.file.text];
    if (from === to) return line;
    const [a, b] = [from.split("\n"), to.split("\n")];
    let same = 0;
    while (same < a.length && same < b.length && a[same] === b[same]) same += 1;
    if (line < same) return line;
    let end = 0;
    while (end < a.length - same && end < b.length - same && a[a.length - 1 - end] === b[b.length - 1 - end]) end += 1;
    if (line >= a.length - end || a.length === b.length) return line + b.length - a.length;
    return -1;
  }

  /** Selects the node of a line. @param {number} line */
  selectNode(line) {
    const built = this.other(line);
    const node = robot.about?.nodes.find((node) => node.file === this.shown && node.line === built + 1);
    if (node && node.name !== robot.selected) select(node.name, "text");
  }

  /** Shows the line of a node. @param {string | null} name @param {string} [by] */
  select(name, by) {
    const node = robot.about?.nodes.find((node) => node.name === name);
    if (!node) return this.area.mark(-1, false);
    if (node.file !== this.shown) this.open(node.file);
    this.area.mark(this.other(node.line - 1, false), by !== "text");
  }
}
