// Joins the page's modules as `crankloop page` does, for tests: each module a function, called once, in the order in
// which they need each other; port/wasm/page/README.md says what of the language the modules keep to.

import {createHash} from 'node:crypto';
import {readFileSync} from 'node:fs';

export const kPage = new URL('../../port/wasm/page/', import.meta.url);

/// Of a module beside this one or one folder up; a stand-in has the page's folder in it.
const kImport = /^import\s*\{([^}]*)\}\s*from\s*'(?:\.\/|\.\.\/\.\.\/port\/wasm\/page\/)?((?:\.\.\/)?[\w.-]+)';\n/gm;

/// replaced: module file name -> URL of another one that stands in for it.
export function joined(entry, replaced = {}) {
  const done = new Map();
  const parts = [];
  const visit = (file) => {
    if (done.has(file)) return;
    done.set(file, null);
    const text = readFileSync(new URL(replaced[file] ?? file, kPage), 'utf8');
    const head = [];
    const names = [];
    const body = text
      .replace(kImport, (_, list, from) => {
        visit(from);
        head.push(`const {${list.replace(/\s+/g, ' ').trim()}} = ${done.get(from)};`);
        return '';
      })
      .replace(/^export ((?:async )?(?:function\*?|class|const|let) (\w+))/gm, (_, declared, name) => {
        names.push(name);
        return declared;
      });
    const id = `m_${file.replace(/\W/g, '_')}`;
    done.set(file, id);
    parts.push(`const ${id} = (() => {\n${head.join('\n')}\n${body}\nreturn {${names.join(', ')}};\n})();\n`);
  };
  visit(entry);
  return `(() => {\n'use strict';\n${parts.join('')}})();\n`;
}

/// Text for a script or data block: nothing in it ends the block.
const guarded = (text) => text.replaceAll('</', '<\\/').replaceAll('<!--', '<\\!--');
const json = (value) => JSON.stringify(value).replaceAll('<', '\\u003c');
const escaped = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;');

export function pageOf({source, module = '', proof = '', golden = [], replaced = {}}) {
  const script = guarded(joined('main.mjs', replaced));
  const style = readFileSync(new URL('page.css', kPage), 'utf8');
  const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
  const values = {
    POLICY: `default-src 'none'; script-src ${hash(script)} 'wasm-unsafe-eval'; worker-src blob:; ` +
            `style-src ${hash(style)}; img-src data: blob:`,
    TITLE: escaped(source.path), STYLE: style, ENGINE: json(source), GOLDEN: json(golden), MODULE: module,
    DOUBLE: '', PROOF: proof, WORKER: guarded(joined('worker.mjs', replaced)), SCRIPT: script,
  };
  return readFileSync(new URL('page.html', kPage), 'utf8').replace(/%%(\w+)%%/g, (_, name) => values[name]);
}
