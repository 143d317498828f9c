// Puts the page together: `node build.mjs OUT`. The bindings of the modules are in `pkg`.

import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2];
const read = (name) => readFileSync(join(here, name));

/** A script, and the style sheets that it brings. */
async function bundle(entry, options = {}) {
  const result = await build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: ["es2022"],
    charset: "utf8",
    legalComments: "none",
    outdir: "out",
    loader: { ".txt": "text", ".toml": "text", ".css": "text" },
    ...options,
  });
  return result.outputFiles[0].text;
}

const licence = (name) => {
  const folder = join(here, "node_modules", name);
  const file = readdirSync(folder).find((file) => /^licen[cs]e/i.test(file));
  return `${name} ${JSON.parse(readFileSync(join(folder, "package.json"))).version}\n\n${readFileSync(join(folder, file))}`;
};

const style = `${read("node_modules/uplot/dist/uPlot.min.css")}body{margin:0}\n${read("src/style.css")}`
  .replace(/\/\*[^]*?\*\//g, "")
  .replace(/\s*\n\s*/g, "\n");
const wasm = read("pkg/slipstick_web_bg.wasm");
const firstWasm = read("pkg/slipstick_first_bg.wasm");
// A module by itself: what it brings with it stands in it.
const { first } = await import(`data:text/javascript;base64,${Buffer.from(await bundle("painted.ts", { format: "esm" })).toString("base64")}`);
const bindings = join(here, "pkg/slipstick_first.js");
const ofFirst = { name: "first", setup: (build) => build.onResolve({ filter: /\/pkg\/slipstick_web\.js$/ }, () => ({ path: bindings })) };
const [app, worker, firstWorker, single, loader] = await Promise.all([bundle("folder.ts"), bundle("worker.ts"), bundle("worker.ts", { plugins: [ofFirst] }), bundle("single.ts"), bundle("loader.ts")]);

rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
const files = {
  "index.html": read("index.html"),
  "app.css": style,
  "app.js": app,
  "worker.js": worker,
  "first.json": first(wasm),
  "first.js": firstWorker,
  "first.wasm": firstWasm,
  "slipstick.wasm": wasm,
  "icon.svg": read("icon.svg"),
  "manifest.webmanifest": JSON.stringify({
    name: "Slipstick",
    short_name: "Slipstick",
    start_url: "./",
    display: "standalone",
    background_color: "#f3f4f1",
    theme_color: "#0d5c63",
    icons: [{ src: "icon.svg", sizes: "any", type: "image/svg+xml" }],
  }),
  "licences.txt": `The page contains:\n\n${licence("uplot")}\n\n${licence("fflate")}`,
};
const hash = createHash("sha256");
for (const data of Object.values(files)) hash.update(data);
files["service-worker.js"] = await bundle("service-worker.ts", {
  define: {
    SLIPSTICK_FILES: JSON.stringify(["./", ...Object.keys(files).filter((name) => name !== "index.html")]),
    SLIPSTICK_BUILD: JSON.stringify(hash.digest("hex").slice(0, 16)),
  },
});

// A script's text must not end its element.
const inline = (script) => script.replace(/<\/(script)/gi, "<\\/$1").replace(/<!--/g, "<\\!--");
const pack = (data) => gzipSync(data, { level: 9 }).toString("base64");
const packed = pack(wasm);
const parts = { icon: read("icon.svg").toString("base64"), style, wasm: packed, worker: inline(worker), app: pack(single), loader: inline(loader) };
const whole = read("single.html").toString().replace(/\{(icon|style|wasm|worker|app|loader)\}/g, (_, name) => parts[name]);

const widget = await bundle("widget.ts", {
  format: "esm",
  define: { SLIPSTICK_WASM: JSON.stringify(packed), SLIPSTICK_WORKER: JSON.stringify(worker), SLIPSTICK_STYLE: JSON.stringify(style) },
});
if (process.argv[3]) writeFileSync(process.argv[3], widget);

for (const [name, data] of Object.entries(files)) writeFileSync(join(out, name), data);
const zipped = Object.values(files).reduce((sum, data) => sum + gzipSync(data, { level: 9 }).length, 0);
writeFileSync(join(out, "slipstick.html"), whole);

const kB = (bytes) => `${Math.round(bytes / 1000)} kB`;
const early = ["index.html", "app.css", "app.js", "first.json", "icon.svg", "manifest.webmanifest"];
const before = early.reduce((sum, name) => sum + gzipSync(files[name], { level: 9 }).length, 0);
console.log(`folder ${kB(zipped)} gzipped (before the first picture ${kB(before)}, first module ${kB(gzipSync(firstWasm, { level: 9 }).length)}, module ${kB(gzipSync(wasm, { level: 9 }).length)}), slipstick.html ${kB(whole.length)}`);
