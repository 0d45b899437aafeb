// node run.mjs IMAGE.wasm: starts it as a process of this machine; its text goes to standard error.
import {readFileSync} from 'node:fs';

import {runImage} from './wasi.mjs';

const image = new WebAssembly.Module(readFileSync(process.argv[2]));
process.exitCode = runImage(image, (text) => process.stderr.write(text));
