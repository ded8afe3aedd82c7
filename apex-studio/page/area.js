// @ts-check
// A plain editing area over coloured text: a text field without colour above what it says in colours.
import { ask, tip } from "./page.js";

/** @typedef {{from: [number, number], to: [number, number], is_error: boolean, text: string, concerns: {within: string, names: string[], connects: boolean}[]}} Found */
/** @typedef {{label: string, detail: string, docs: string, from: [number, number], to: [number, number], text: string, import: [number, string] | null}} Completion */
/** @typedef {{changed: (text: string) => void, moved: (line: number) => void, place: (line: number, column: number) => [number, number, number]}} Asking */

const KINDS = ["", "comment", "docs", "keyword", "type", "string", "number", "arrow"];

/** @param {string} kind @param {string} name */
function make(kind, name) {
  const made = document.createElement(kind);
  made.className = name;
  return made;
}

export class Area {
  /** @param {HTMLElement} place @param {Asking} asking */
  constructor(place, asking) {
    this.place = place;
    this.asking = asking;
    this.paper = make("pre", "paper");
    this.paper.setAttribute("aria-hidden", "true");
    this.input = /** @type {HTMLTextAreaElement} */ (make("textarea", "input"));
    Object.assign(this.input, { spellcheck: false, autocomplete: "off", autocapitalize: "off", wrap: "off" });
    this.input.setAttribute("aria-label", "source text");
    this.menu = make("ul", "menu");
    this.menu.setAttribute("role", "listbox");
    this.menu.hidden = true;
    const sheet = make("div", "sheet");
    sheet.append(this.paper, this.input, this.menu);
    place.replaceChildren(sheet);
    /** @type {Found[]} */ this.found = [];
    /** @type {[number, number][]} */ this.pieces = [];
    /** @type {Completion[]} */ this.items = [];
    this.chosen = 0;
    this.marked = -1;
    /** The last place that the pointer was at. */ this.pointed = "";
    this.timer = 0;
    this.listen();
  }

  /** Shows a text. @param {string} text @param {boolean} readonly @param {boolean} top */
  show(text, readonly, top) {
    if (this.input.value !== text) {
      const at = this.input.selectionStart;
      this.input.value = text;
      this.input.setSelectionRange(top ? 0 : at, top ? 0 : at);
      this.pieces = [];
    }
    this.input.readOnly = readonly;
    if (top) this.place.scrollTop = 0;
    this.close();
    this.draw();
  }

  /** Shows colours and errors. @param {[number, number][]} pieces @param {Found[]} found */
  paint(pieces, found) {
    this.pieces = pieces;
    this.found = found;
    this.draw();
  }

  /** The text in colours, one row for each line. */
  draw() {
    const text = this.input.value;
    const marks = this.found.map(({ from, to, is_error }) => {
      const [start, end] = [this.offset(from[0], from[1]), this.offset(to[0], to[1])];
      return { start, end: Math.max(end, start + 1), name: is_error ? "wrong" : "doubtful" };
    });
    const cuts = new Set([0, text.length, ...marks.flatMap(({ start, end }) => [start, Math.min(end, text.length)])]);
    /** @type {[number, string][]} */ const colors = [];
    let at = 0;
    for (const [length, kind] of this.pieces) {
      colors.push([at, KINDS[kind]]);
      cuts.add(at);
      at += length;
    }
    for (let line = text.indexOf("\n"); line >= 0; line = text.indexOf("\n", line + 1)) cuts.add(line + 1);
    const places = [...cuts].filter((cut) => cut <= text.length).sort((a, b) => a - b);
    const rows = [this.row(0)];
    let color = 0;
    places.forEach((start, index) => {
      const end = places[index + 1] ?? start;
      while (color + 1 < colors.length && colors[color + 1][0] <= start) color += 1;
      const part = text.slice(start, end);
      const names = [colors[color]?.[1] ?? "", ...marks.filter((mark) => mark.start <= start && start < mark.end).map(({ name }) => name)];
      const name = names.filter(Boolean).join(" ");
      const row = rows[rows.length - 1];
      if (name === "") row.append(part);
      else {
        const piece = make("span", name);
        piece.textContent = part;
        row.append(piece);
      }
      if (part.endsWith("\n")) rows.push(this.row(rows.length));
    });
    for (const { from, is_error } of this.found) rows[from[0]]?.classList.add(is_error ? "has-error" : "has-warning");
    this.paper.replaceChildren(...rows);
    this.paper.style.setProperty("--digits", String(Math.max(2, String(rows.length).length)));
    this.mark(this.marked, false);
  }

  /** @param {number} line */
  row(line) {
    const row = make("span", "row");
    row.dataset.line = String(line + 1);
    return row;
  }

  /** Marks a line, and scrolls to it. @param {number} line @param {boolean} look */
  mark(line, look) {
    this.paper.querySelector(".is-selected")?.classList.remove("is-selected");
    this.marked = line;
    const row = this.paper.children[line];
    row?.classList.add("is-selected");
    if (look && row) this.see(row);
  }

  /** @param {Element} row */
  see(row) {
    const [top, height] = [/** @type {HTMLElement} */ (row).offsetTop, this.place.clientHeight];
    if (top < this.place.scrollTop || top > this.place.scrollTop + height - 40) this.place.scrollTop = top - height / 2;
  }

  /** Line and column of the caret. @returns {[number, number]} */
  caret() {
    const before = this.input.value.slice(0, this.input.selectionStart);
    const line = before.split("\n").length - 1;
    return [line, before.length - before.lastIndexOf("\n") - 1];
  }

  /** @param {number} line @param {number} column */
  offset(line, column) {
    const { value } = this.input;
    let start = 0;
    for (let at = 0; at < line; at += 1) {
      const end = value.indexOf("\n", start);
      if (end < 0) return value.length;
      start = end + 1;
    }
    const end = value.indexOf("\n", start);
    return Math.min(start + column, end < 0 ? value.length : end);
  }

  /** Sets the caret. @param {number} line @param {number} column */
  go(line, column) {
    const at = this.offset(line, column);
    this.input.focus();
    this.input.setSelectionRange(at, at);
    const row = this.paper.children[line];
    if (row) this.see(row);
    this.asking.moved(line);
  }

  /** Replaces a range as if it was typed, so that it can be undone. @param {number} from @param {number} to @param {string} text */
  insert(from, to, text) {
    this.input.focus();
    this.input.setSelectionRange(from, to);
    document.execCommand("insertText", false, text);
  }

  /** Width of a character and height of a line. */
  size() {
    const style = getComputedStyle(this.input);
    const measure = make("span", "");
    measure.textContent = "0".repeat(100);
    measure.style.cssText = "position:absolute;visibility:hidden";
    this.paper.append(measure);
    const width = measure.getBoundingClientRect().width / 100;
    measure.remove();
    return { width, height: parseFloat(style.lineHeight), left: parseFloat(style.paddingLeft), top: parseFloat(style.paddingTop) };
  }

  /** Line and column under the pointer; `null` beside the text. @param {MouseEvent} event @returns {[number, number] | null} */
  under(event) {
    const box = this.input.getBoundingClientRect();
    const { width, height, left, top } = this.size();
    const [line, column] = [Math.floor((event.clientY - box.top - top) / height), Math.floor((event.clientX - box.left - left) / width)];
    const text = this.input.value.split("\n")[line];
    return text === undefined || column < 0 || column >= text.length ? null : [line, column];
  }

  /** Errors at a place, as words. @param {number} line @param {number} column */
  errors(line, column) {
    const is = ([l, c] = [0, 0], strict = false) => l < line || (l === line && (strict ? c < column : c <= column));
    return this.found.filter(({ from, to }) => is(from) && !is(to, true)).map(({ text }) => text);
  }

  /** Shows a description. @param {[number, number, number]} place @param {string} text */
  hover([, line, column], text) {
    if (this.pointed !== `${line}:${column}`) return;
    const words = [...this.errors(line, column), plain(text)].filter(Boolean).join("\n\n");
    const { width, height, left, top } = this.size();
    const box = this.input.getBoundingClientRect();
    const at = { clientX: box.left + left + column * width, clientY: box.top + top + (line + 1) * height - 8 };
    tip(words || null, /** @type {any} */ (at));
  }

  /** Asks for a description. @param {number} line @param {number} column */
  ask(line, column) {
    this.pointed = `${line}:${column}`;
    const errors = this.errors(line, column);
    if (errors.length > 0) this.hover([0, line, column], "");
    ask({ hover: this.asking.place(line, column) });
  }

  /** Shows completions. @param {[number, number, number]} place @param {Completion[]} items */
  complete([, line, column], items) {
    const [now, at] = this.caret();
    if (now !== line || at < column || document.activeElement !== this.input) return;
    const typed = items.length > 0 ? this.input.value.slice(this.offset(line, items[0].from[1]), this.offset(now, at)).toLowerCase() : "";
    const score = (/** @type {Completion} */ item) => {
      const label = item.label.toLowerCase();
      return label.startsWith(typed) ? 0 : label.includes(typed) ? 1 : 2;
    };
    this.items = items.filter((item) => score(item) < 2).sort((a, b) => score(a) - score(b)).slice(0, 40);
    // Nothing is left to do for a word that is complete.
    if (this.items.length === 0 || (this.items.length === 1 && this.items[0].label.toLowerCase() === typed)) return this.close();
    this.choose(0);
    this.menu.replaceChildren(...this.items.map((item, index) => {
      const [row, detail] = [make("li", ""), make("span", "detail")];
      row.setAttribute("role", "option");
      detail.textContent = item.detail;
      row.append(item.label, detail);
      row.addEventListener("pointerdown", (event) => {
        event.preventDefault();
        this.choose(index);
        this.accept();
      });
      return row;
    }));
    this.menu.hidden = false;
    const { width, height, left, top } = this.size();
    const column_ = this.items[0].from[1];
    this.menu.style.left = `${Math.min(left + column_ * width, Math.max(left, this.place.scrollLeft + this.place.clientWidth - 280))}px`;
    const below = top + (line + 1) * height;
    const room = this.place.scrollTop + this.place.clientHeight - below;
    const tall = Math.min(this.menu.scrollHeight, 180);
    this.menu.style.top = `${room < tall && below - height - tall > this.place.scrollTop ? below - height - tall - 2 : below}px`;
    this.choose(0);
  }

  /** @param {number} index */
  choose(index) {
    this.chosen = (index + this.items.length) % Math.max(1, this.items.length);
    [...this.menu.children].forEach((row, at) => row.setAttribute("aria-selected", String(at === this.chosen)));
    this.menu.children[this.chosen]?.scrollIntoView({ block: "nearest" });
  }

  /** Takes the chosen completion. */
  accept() {
    const item = this.items[this.chosen];
    this.close();
    if (!item) return;
    this.insert(this.offset(item.from[0], item.from[1]), this.input.selectionStart, item.text);
    if (item.import === null) return;
    const [line, text] = item.import;
    const [at, caret] = [this.offset(line, 0), this.input.selectionStart];
    this.insert(at, at, text);
    this.input.setSelectionRange(caret + text.length, caret + text.length);
  }

  close() {
    this.menu.hidden = true;
    this.menu.replaceChildren();
    this.items = [];
  }

  /** Keys of the area. @param {KeyboardEvent} event */
  key(event) {
    const opened = !this.menu.hidden;
    const { key, ctrlKey } = event;
    /** @type {(() => void) | undefined} */ let act;
    if (opened && key === "ArrowDown") act = () => this.choose(this.chosen + 1);
    else if (opened && key === "ArrowUp") act = () => this.choose(this.chosen - 1);
    else if (opened && (key === "Enter" || key === "Tab")) act = () => this.accept();
    else if (opened && key === "Escape") act = () => this.close();
    else if (key === " " && ctrlKey) act = () => ask({ complete: this.asking.place(...this.caret()) });
    else if (key === "F1") act = () => this.ask(...this.caret());
    else if (key === "Tab" && !event.shiftKey && !this.input.readOnly && !this.leaves) act = () => this.insert(this.input.selectionStart, this.input.selectionEnd, "    ");
    else if (key === "Enter" && !this.input.readOnly && !ctrlKey) act = () => this.newLine();
    // After Escape, Tab leaves the area, as everywhere else.
    this.leaves = key === "Escape" && !opened;
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  }

  /** A new line, indented as the one before. */
  newLine() {
    const { selectionStart: start, selectionEnd: end, value } = this.input;
    const line = value.slice(value.lastIndexOf("\n", start - 1) + 1, start);
    const indent = /^\s*/.exec(line)?.[0] ?? "";
    this.insert(start, end, `\n${indent}${/[{(]\s*$/.test(line) ? "    " : ""}`);
  }

  listen() {
    const { input } = this;
    input.addEventListener("input", (event) => {
      // Until the new colours come, the old ones end where the texts differ.
      this.shift();
      this.asking.changed(input.value);
      const typed = /** @type {InputEvent} */ (event).data ?? "";
      if (/^[\w.:(>=]$/.test(typed)) ask({ complete: this.asking.place(...this.caret()) });
      else this.close();
    });
    input.addEventListener("keydown", (event) => this.key(event));
    input.addEventListener("keyup", (event) => {
      if (event.key.startsWith("Arrow") || event.key.startsWith("Page")) this.asking.moved(this.caret()[0]);
    });
    input.addEventListener("click", () => {
      this.close();
      this.asking.moved(this.caret()[0]);
    });
    input.addEventListener("blur", () => this.close());
    input.addEventListener("pointermove", (event) => {
      const place = this.under(event);
      const name = place ? place.join(":") : "";
      if (name === this.pointed) return;
      this.pointed = name;
      tip(null);
      clearTimeout(this.timer);
      if (place) this.timer = window.setTimeout(() => this.ask(place[0], place[1]), 250);
    });
    input.addEventListener("pointerleave", () => {
      clearTimeout(this.timer);
      this.pointed = "";
      tip(null);
    });
  }

  /** Keeps the colours of what has not changed. */
  shift() {
    const [before, now] = [this.paper.textContent ?? "", this.input.value];
    let [same, end] = [0, 0];
    const shorter = Math.min(before.length, now.length);
    while (same < shorter && before[same] === now[same]) same += 1;
    while (end < shorter - same && before[before.length - 1 - end] === now[now.length - 1 - end]) end += 1;
    const first = cut(this.pieces, 0, same);
    // What is typed has the colour of what it is behind.
    const kind = first[first.length - 1]?.[1] ?? 0;
    this.pieces = [...first, [now.length - same - end, kind], ...cut(this.pieces, before.length - end, before.length)];
    this.draw();
  }
}

/** The pieces between two places. @param {[number, number][]} pieces @param {number} from @param {number} to @returns {[number, number][]} */
function cut(pieces, from, to) {
  let at = 0;
  return pieces.flatMap(([length, kind]) => {
    const [start, end] = [Math.max(at, from), Math.min(at + length, to)];
    at += length;
    return end > start ? [[end - start, kind]] : [];
  });
}

/** Markdown as plain words. @param {string} text */
const plain = (text) => text.replace(/```\w*\n?/g, "").replace(/\n---\n/g, "\n").replace(/\n{3,}/g, "\n\n").trim();
