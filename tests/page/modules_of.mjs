// The engine's module as preset page has made it, for tests under Node.

import {existsSync, readFileSync} from 'node:fs';
import {join} from 'node:path';

import {openModule} from '../../port/wasm/page/module.mjs';

export function hasModules(folder) { return existsSync(join(folder, 'engine.wasm')); }

/// Both parts, of a folder.
export function openedModule(folder) {
  return openModule(readFileSync(join(folder, 'engine.wasm')), () => readFileSync(join(folder, 'engine_double.wasm')));
}
