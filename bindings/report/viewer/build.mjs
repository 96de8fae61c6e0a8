// Makes the page of the report: one HTML file with style and program inside, and a line
// "@QUADCOVER_DATA@" where the run goes. `node build.mjs OUT.html`; `npm run build` writes ../viewer.html.
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const source = (name) => join(here, 'src', name);
const bundle = await build({
  entryPoints: [source('main.js')],
  absWorkingDir: here,
  bundle: true,
  write: false,
  minify: true,
  format: 'esm',
  target: 'es2022',
  charset: 'ascii',
  legalComments: 'inline',
});
const script = bundle.outputFiles[0].text.trimEnd().replaceAll('</script', '<\\/script');
const style = readFileSync(source('style.css'), 'utf8').trimEnd();
const page = readFileSync(source('page.html'), 'utf8');
writeFileSync(process.argv[2], page.replace('@STYLE@', () => style).replace('@SCRIPT@', () => script));
