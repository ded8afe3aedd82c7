// @ts-check
// Tokens of ports: numbers as plots, all else as text.
import { ask, empty, robot } from "./studio.js";

const MAX = 4000;

export class Values {
  /** @param {HTMLElement} place @param {HTMLInputElement} filter */
  constructor(place, filter) {
    this.place = place;
    this.filter = filter;
    /** Pinned channels, by name: they survive a restart. @type {Set<string>} */ this.pinned = new Set();
    /** @type {Map<number, {time: number, text: string}[]>} */ this.tokens = new Map();
    /** @type {Map<number, HTMLElement>} */ this.rows = new Map();
    filter.addEventListener("input", () => this.list());
  }

  begin() {
    this.tokens.clear();
    this.list();
    this.watch();
  }

  /** @param {string | null} _name */
  select(_name) { this.list(); }

  /** Channels that can be shown: pinned ones, those of the selected node, and those that the filter finds. */
  channels() {
    const words = this.filter.value.toLowerCase();
    return (robot.about?.channels ?? []).flatMap(({ name, node, shown }, at) => {
      const owner = robot.about?.nodes[node]?.name ?? "";
      const near = robot.selected !== null && (owner === robot.selected || owner.startsWith(`${robot.selected}.`));
      const found = words !== "" ? name.toLowerCase().includes(words) : near || robot.selected === null;
      return shown && (this.pinned.has(name) || found) ? [{ name, at }] : [];
    }).slice(0, 300);
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
      box.addEventListener("change", () => {
        if (box.checked) this.pinned.add(name);
        else this.pinned.delete(name);
        this.tokens.delete(at);
        this.list();
        this.watch();
      });
      label.append(box, ` ${name}`);
      row.append(label);
      this.rows.set(at, row);
      return row;
    }));
    if (channels.length === 0) this.place.append(empty("no port whose tokens can be shown"));
    for (const at of this.rows.keys()) this.draw(at);
  }

  /** Tells the studio which tokens are wanted. */
  watch() {
    const channels = robot.about?.channels ?? [];
    ask({ watch: channels.flatMap(({ name }, at) => (this.pinned.has(name) ? [at] : [])) });
  }

  /** @param {Record<string, [number, string][]>} all */
  update(all) {
    for (const [channel, tokens] of Object.entries(all)) {
      const at = Number(channel);
      const kept = this.tokens.get(at) ?? [];
      kept.push(...tokens.map(([time, text]) => ({ time, text })));
      this.tokens.set(at, kept.slice(-MAX));
      this.draw(at);
    }
  }

  /** @param {number} at */
  draw(at) {
    const row = this.rows.get(at);
    const tokens = this.tokens.get(at);
    if (!row || !tokens || tokens.length === 0) return;
    const last = tokens[tokens.length - 1];
    let text = row.querySelector("pre");
    if (!text) {
      text = document.createElement("pre");
      row.append(text);
    }
    text.textContent = last.text;
    const numbers = tokens.map(({ time, text }) => ({ time, value: Number(text) })).filter(({ value }) => Number.isFinite(value));
    if (numbers.length > 1 && Number.isFinite(Number(last.text))) this.plot(row, numbers);
  }

  /** @param {HTMLElement} row @param {{time: number, value: number}[]} numbers */
  plot(row, numbers) {
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
    const seen = numbers.filter(({ time }) => time >= start);
    const [low, high] = [Math.min(...seen.map((n) => n.value)), Math.max(...seen.map((n) => n.value))];
    const x = (/** @type {number} */ time) => ((time - start) / Math.max(1e-9, end - start)) * (width - 4) + 2;
    const y = (/** @type {number} */ value) => height - 12 - ((value - low) / (high - low || 1)) * (height - 24);
    c.strokeStyle = style.getPropertyValue("--fire");
    c.lineWidth = 1.5;
    c.beginPath();
    for (const { time, value } of seen) c.lineTo(x(time), y(value));
    c.stroke();
    c.fillStyle = style.getPropertyValue("--soft");
    c.font = "10px system-ui, sans-serif";
    c.fillText(String(high), 2, 9);
    c.fillText(String(low), 2, height - 2);
  }
}
