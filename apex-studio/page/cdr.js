// @ts-check
// Messages of ROS 2 in CDR, read by their definitions.

/** @typedef {{name: string, type: string, list: "" | "many" | number}} Field */

/** @type {Record<string, number>} */
const SIZES = { bool: 1, byte: 1, char: 1, int8: 1, uint8: 1, int16: 2, uint16: 2, int32: 4, uint32: 4, int64: 8, uint64: 8, float32: 4, float64: 8 };

/** Types that definitions may leave out. */
const KNOWN = "\n====\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n====\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n====\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec";

/** Reads a definition. The first type has no name. @param {string} definition @returns {Map<string, Field[]>} */
function types(definition) {
  const all = new Map();
  for (const part of `${definition}${KNOWN}`.split(/\n=+\n/)) {
    const lines = part.split("\n").map((line) => line.replace(/#.*/, "").trim()).filter((line) => line !== "");
    const name = lines[0]?.startsWith("MSG: ") ? lines.shift()?.slice(5) : "";
    const fields = lines.filter((line) => !line.includes("=")).map((line) => {
      const [type, name] = line.split(/\s+/);
      const [, base, count] = /^([^[]+)(?:\[(.*)\])?$/.exec(type) ?? [];
      return { name, type: base, list: count === undefined ? "" : /^\d+$/.test(count) ? Number(count) : "many" };
    });
    if (!all.has(name)) all.set(name, fields);
  }
  return all;
}

/** Reader of the messages of one definition. */
export class Definition {
  /** @param {string} definition */
  constructor(definition) { this.types = types(definition); }

  /** Reads a message; `null` if the bytes are not one. @param {Uint8Array} bytes */
  read(bytes) {
    try {
      return new Reader(bytes, this.types).message("");
    } catch {
      return null;
    }
  }
}

class Reader {
  /** @param {Uint8Array} bytes @param {Map<string, Field[]>} types */
  constructor(bytes, types) {
    this.types = types;
    this.little = bytes[1] === 1;
    // Numbers are aligned from the end of the header of four bytes on.
    this.view = new DataView(bytes.buffer, bytes.byteOffset + 4, bytes.byteLength - 4);
    this.at = 0;
  }

  /** @param {string} type @returns {any} */
  message(type) {
    const fields = this.types.get(type) ?? this.types.get(type.replace("/msg/", "/"));
    if (!fields) throw new Error(`unknown type ${type}`);
    return Object.fromEntries(fields.map((field) => [field.name, this.field(field)]));
  }

  /** @param {Field} field @returns {any} */
  field({ type, list }) {
    if (list === "") return this.one(type);
    const count = list === "many" ? this.number("uint32") : list;
    if (type === "uint8" || type === "byte") {
      this.at += count;
      if (this.at > this.view.byteLength) throw new Error("the message is too short");
      return new Uint8Array(this.view.buffer, this.view.byteOffset + this.at - count, count);
    }
    if (count > this.view.byteLength) throw new Error("the message is too short");
    return Array.from({ length: count }, () => this.one(type));
  }

  /** @param {string} type @returns {any} */
  one(type) {
    if (type in SIZES) return this.number(type);
    if (type !== "string") return this.message(type);
    const length = this.number("uint32");
    const bytes = new Uint8Array(this.view.buffer, this.view.byteOffset + this.at, Math.max(0, length - 1));
    this.at += length;
    return new TextDecoder().decode(bytes);
  }

  /** @param {string} type @returns {any} */
  number(type) {
    const size = SIZES[type];
    this.at = Math.ceil(this.at / size) * size;
    const at = this.at;
    this.at += size;
    const { view, little } = this;
    switch (type) {
      case "bool": return view.getUint8(at) !== 0;
      case "int8": return view.getInt8(at);
      case "int16": return view.getInt16(at, little);
      case "uint16": return view.getUint16(at, little);
      case "int32": return view.getInt32(at, little);
      case "uint32": return view.getUint32(at, little);
      case "int64": return Number(view.getBigInt64(at, little));
      case "uint64": return Number(view.getBigUint64(at, little));
      case "float32": return view.getFloat32(at, little);
      case "float64": return view.getFloat64(at, little);
      default: return view.getUint8(at);
    }
  }
}
