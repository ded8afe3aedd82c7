// @ts-check
// Names of boxes at a fixed size on the screen, however small the picture is.

/** A box of the picture with its place in it. @typedef {{path: string, element: Element, x: number, y: number, width: number, height: number, isFrame: boolean}} Box */
/** Words beside boxes, with the point at which they begin, end, or have their middle. @typedef {{words: string, x: number, y: number, anchor: string}} Words */
/** A place on the screen that words take. @typedef {{left: number, top: number, right: number, bottom: number}} Taken */

/** Size of the letters in pixels. */
const SIZE = 12;
/** Width in pixels of the least that is worth reading, and the height of a box that can have a name. */
const LEAST = 24;
const LOWEST = 6;

const ruler = document.createElement("canvas").getContext("2d");

/** Width of a name in pixels. @param {string} name */
function width(name) {
  if (!ruler) return name.length * SIZE * 0.6;
  ruler.font = `bold ${SIZE}px Helvetica, Arial, "DejaVu Sans", sans-serif`;
  return ruler.measureText(name).width;
}

/** As much of a name as there is room for. @param {string} name @param {number} room */
function shortened(name, room) {
  const full = width(name);
  if (full <= room) return name;
  const letters = Math.floor((name.length * room) / full) - 1;
  return letters < 2 ? "" : `${name.slice(0, letters)}…`;
}

/** `true` if two places overlap. @param {Taken} one @param {Taken} other */
const meets = (one, other) => one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom;

/** The place of a box. @param {Box} box @param {number} scale @returns {Taken} */
const onScreen = ({ x, y, width, height }, scale) => ({ left: x * scale, top: y * scale, right: (x + width) * scale, bottom: (y + height) * scale });

export class Labels {
  constructor() {
    /** @type {SVGGElement | null} */ this.group = null;
    /** @type {(Box & {name: string, label: Element, since: Element})[]} */ this.all = [];
    /** @type {(Words & {label: Element})[]} */ this.words = [];
    /** How they were placed last. @type {{scale: number, selected: string | null} | null} */ this.last = null;
  }

  /** Begins with the boxes of a picture, and words beside them. @param {SVGSVGElement} svg @param {Box[]} boxes @param {Words[]} words */
  begin(svg, boxes, words) {
    const make = (/** @type {string} */ kind, /** @type {string} */ name) => {
      const made = document.createElementNS("http://www.w3.org/2000/svg", kind);
      made.setAttribute("class", name);
      this.group?.append(made);
      return made;
    };
    this.group = /** @type {SVGGElement} */ (make("g", "labels"));
    svg.append(this.group);
    this.all = boxes.map((box) => ({
      ...box,
      name: box.path.split(".").pop() ?? "",
      label: make("text", box.isFrame ? "label of-frame" : "label"),
      since: make("text", "label small since"),
    }));
    // Graphs before what is in them: their names say more.
    this.all.sort((a, b) => Number(b.isFrame) - Number(a.isFrame) || a.path.split(".").length - b.path.split(".").length);
    this.words = words.map((words) => ({ ...words, label: make("text", "label small") }));
  }

  /** Shows below the name of a box since when it is active, or nothing. @param {string} path @param {string} words */
  say(path, words) {
    const box = this.all.find((box) => box.path === path);
    if (!box || !this.last) return;
    const moves = (words === "") !== (box.since.textContent === "");
    box.since.textContent = words;
    if (moves) this.place(this.last.scale, this.last.selected);
  }

  /** Places the names for a number of pixels per unit. That of the selected box comes first. @param {number} scale @param {string | null} selected */
  place(scale, selected) {
    if (!this.group) return;
    this.last = { scale, selected };
    this.group.style.fontSize = `${SIZE / scale}px`;
    this.group.style.strokeWidth = `${3 / scale}px`;
    /** @type {Taken[]} */ const taken = [];
    const first = this.all.filter(({ path }) => path === selected);
    for (const box of [...first, ...this.all.filter(({ path }) => path !== selected)]) {
      const words = this.fitting(box, scale, taken);
      if (box.label.textContent !== words) box.label.textContent = words;
    }
    // Words beside boxes do not lie over them.
    taken.push(...this.all.filter(({ isFrame }) => !isFrame).map((box) => onScreen(box, scale)));
    for (const { words, x, y, anchor, label } of this.words) {
      const wide = width(words);
      const left = x * scale - (anchor === "middle" ? wide / 2 : anchor === "end" ? wide : 0);
      label.textContent = this.put(label, { left, top: y * scale - SIZE + 2, right: left + wide, bottom: y * scale + 2 }, scale, taken) ? words : "";
    }
  }

  /** Puts a label where nothing else is. Returns `false` if there is something. @param {Element} label @param {Taken} own @param {number} scale @param {Taken[]} taken */
  put(label, own, scale, taken) {
    if (taken.some((other) => meets(own, other))) return false;
    taken.push(own);
    label.setAttribute("x", String(own.left / scale));
    label.setAttribute("y", String((own.bottom - 2) / scale));
    return true;
  }

  /** Words for a box that fit where nothing else is; their place becomes `taken`. @param {Labels["all"][0]} box @param {number} scale @param {Taken[]} taken */
  fitting(box, scale, taken) {
    const { x, y, width: w, height: h, isFrame, name, label, since } = box;
    const [middle, hasTwo] = [(x + w / 2) * scale, h * scale > 2 * SIZE];
    since.toggleAttribute("hidden", !hasTwo);
    if (w * scale < LEAST / 2 || h * scale < LOWEST) return "";
    const top = isFrame ? y * scale + 1 : (y + h / 2) * scale - (hasTwo && since.textContent ? SIZE : SIZE / 2);
    const own = (/** @type {string} */ words) => {
      const wide = width(words);
      const left = isFrame ? x * scale + 4 : middle - wide / 2;
      return { left, top, right: left + wide, bottom: top + SIZE };
    };
    // A name may be longer than its box, but does not lie over another one.
    const isFree = (/** @type {Taken} */ place) => this.all.every((other) => other === box || other.isFrame || !meets(place, onScreen(other, scale)));
    const room = isFrame ? w * scale - 8 : w * scale + 8;
    const tried = [!isFrame && isFree(own(name)) ? name : "", shortened(name, room)];
    const words = tried.find((words) => words !== "" && this.put(label, own(words), scale, taken));
    if (!words) return "";
    since.setAttribute("x", String(middle / scale));
    since.setAttribute("y", String((top + 2 * SIZE - 1) / scale));
    return words;
  }
}
