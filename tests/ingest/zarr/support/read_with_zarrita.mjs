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

/** A shard in a shard, which zarrita does not know: an array of one object, which it does. */
class InnerShard {
  kind = "array_to_bytes";
  constructor(configuration, chunk) {
    const grid = { name: "regular", configuration: { chunk_shape: chunk.shape } };
    const codecs = [{ name: "sharding_indexed", configuration }];
    this.metadata = { zarr_format: 3, node_type: "array", shape: chunk.shape, data_type: chunk.dataType, chunk_grid: grid,
                      chunk_key_encoding: { name: "default" }, codecs, fill_value: chunk.fillValue, attributes: {} };
  }
  static fromConfig(configuration, chunk) {
    return new InnerShard(configuration, chunk);
  }
  async decode(shard) {
    const store = new Files("");
    const metadata = new TextEncoder().encode(JSON.stringify(this.metadata));
    store.get = async (key) => (key.endsWith("zarr.json") ? metadata : shard);
    const { data, shape, stride } = await zarr.get(await zarr.open.v3(store, { kind: "array" }));
    return { data, shape, stride };
  }
}
zarr.registry.set("sharding_indexed", () => InnerShard);

async function write(name, file, index) {
  const array = await zarr.open(new Files(path.join(directory, file)), { kind: "array" });
  const part = await zarr.get(array, [...index, null, null, null]);
  const [z, y, x] = part.shape;
  const at_index = (i) => (part.data.get ? part.data.get(i) : part.data[i]); // truth values lie in no plain array
  const values = new Float32Array(z * y * x);
  let at = 0;
  for (let k = 0; k < z; ++k)
    for (let j = 0; j < y; ++j)
      for (let i = 0; i < x; ++i)
        values[at++] = Number(at_index(k * part.stride[0] + j * part.stride[1] + i * part.stride[2]));
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
