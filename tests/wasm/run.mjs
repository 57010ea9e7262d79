// Renders in wasm and prints the digest of the film.
import { readFile } from "node:fs/promises";

const { instance } = await WebAssembly.instantiate(await readFile(process.argv[2]), {});
const half = (f) => BigInt.asUintN(64, instance.exports[f]()).toString(16).padStart(16, "0");
console.log(half("digest_high") + half("digest_low"));
