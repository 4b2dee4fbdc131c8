// Reads the arrays of write_arrays.py with zarrita: node read_with_zarrita.mjs DIRECTORY NODE_MODULES
// For each line of DIRECTORY/cases.txt of an array in a directory, writes NAME.zarrita, its values as float32;
// those that it cannot read are left out, and said.
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

const [directory, modules] = process.argv.slice(2);
const load = async (name) => {
  const root = path.join(modules, name);
  const entry = JSON.parse(fs.readFileSync(path.join(root, "package.json"))).exports["."];
  return import(pathToFileURL(path.join(root, typeof entry === "string" ? entry : entry.import ?? entry.default)));
};
const zarr = await load("zarrita");

/** Chunks by their keys; undefined where there is none. */
class Files {
  constructor(root) {
    this.root = root;
  }
  async get(key) {
    const file = path.join(this.root, key);
    return fs.existsSync(file) ? new Uint8Array(fs.readFileSync(file)) : undefined;
  }
  async getRange(key, range) {
    const all = await this.get(key);
    if (all === undefined) return undefined;
    if (range.suffixLength !== undefined) return all.slice(all.length - range.suffixLength);
    return all.slice(range.offset, range.offset + range.length);
  }
}

async function write(name, file, index) {
  const array = await zarr.open(new Files(path.join(directory, file)), { kind: "array" });
  const part = await zarr.get(array, [...index, null, null, null]);
  const [z, y, x] = part.shape;
  const values = new Float32Array(z * y * x);
  let at = 0;
  for (let k = 0; k < z; ++k)
    for (let j = 0; j < y; ++j)
      for (let i = 0; i < x; ++i)
        values[at++] = Number(part.data[k * part.stride[0] + j * part.stride[1] + i * part.stride[2]]);
  fs.writeFileSync(path.join(directory, `${name}.zarrita`), new Uint8Array(values.buffer));
}

for (const line of fs.readFileSync(path.join(directory, "cases.txt"), "utf8").trim().split("\n")) {
  const [name, file, , index] = line.split(" ");
  if (!file.endsWith(".zarr")) continue;
  try {
    await write(name, file, index === "-" ? [] : index.split(",").map(Number));
  } catch (error) {
    console.error(`${name}: not read: ${error.message}`); // types and codecs that zarrita, or this node, has not
  }
}
