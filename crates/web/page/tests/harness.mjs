// A browser, a static host that remembers what was asked of it, and pages on it.

import { execFile } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { promisify } from "node:util";
import { gzipSync } from "node:zlib";
import { chromium } from "playwright-core";

const TYPES = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript; charset=utf-8",
  ".css": "text/css; charset=utf-8",
  ".wasm": "application/wasm",
  ".svg": "image/svg+xml",
  ".json": "application/json",
  ".webmanifest": "application/manifest+json",
};

const packed = new Map();
/** A file in gzip, packed once. */
function compressed(file) {
  if (!packed.has(file)) packed.set(file, gzipSync(readFileSync(file), { level: 9 }));
  return packed.get(file);
}

/** Serves a folder on this machine. */
export async function host(folder) {
  const asked = [];
  const server = createServer((request, response) => {
    const path = new URL(request.url, "http://localhost").pathname;
    asked.push(path);
    const file = join(folder, path === "/" ? "index.html" : path);
    if (path.includes("..") || !existsSync(file)) {
      response.writeHead(404).end();
      return;
    }
    // As static hosts do.
    const zipped = /gzip/.test(request.headers["accept-encoding"] ?? "");
    const type = { "content-type": TYPES[extname(file)] ?? "text/plain", "x-content-type-options": "nosniff" };
    response.writeHead(200, zipped ? { ...type, "content-encoding": "gzip" } : type);
    response.end(zipped ? compressed(file) : readFileSync(file));
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { url: `http://localhost:${server.address().port}/`, asked, close: () => server.close() };
}

/** Chromium without anything that looks for a network. */
export function browser() {
  return chromium.launch({
    executablePath: process.env.SLIPSTICK_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
}

/** For a test of the motion itself: elsewhere the picture stands, and what draws it leaves the processor to what is tested. */
export const MOVING = { reducedMotion: "no-preference" };

/** A page with a record of what went wrong on it; its picture stands still but where `MOVING` says otherwise. */
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1300, height: 900 }, serviceWorkers: "block", reducedMotion: "reduce", ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(30_000);
  const said = [];
  page.on("console", (message) => {
    const text = message.text();
    if (["error", "warning"].includes(message.type()) && !/Service Worker registration blocked|preload/.test(text)) said.push(text);
  });
  page.on("pageerror", (error) => said.push(String(error)));
  const outside = [];
  page.on("request", (request) => {
    const at = request.url();
    if (!at.startsWith(url.split("#")[0].replace(/[^/]*$/, "")) && !/^(blob|data):/.test(at)) outside.push(at);
  });
  await page.goto(url);
  await settled(page);
  return { page, context, said, outside, close: () => context.close() };
}

/** Whether a page is at rest; `tell`: what of it does not hold. `any`: where what is wanted has no answer, too. */
export const rest = ([tell, any]) => {
  const app = globalThis.slipstick;
  const holds = {
    "it has drawn an answer": app?.updates > 0,
    "its worker is idle": app?.desk.helper.idle,
    "nothing that is wanted is on its way": app?.desk.rests,
    "what is wanted is judged": any || (app?.judgement !== undefined && !app.desk.refused),
    "all that it knows is drawn": app?.drawn,
  };
  const left = Object.keys(holds).filter((what) => !holds[what]);
  return tell ? left : left.length === 0;
};

/** Waits until what is shown is judged. It asks by a clock: a page that draws no frames would not be asked by them. */
export async function settled(page, timeout = 60_000) {
  try {
    await page.waitForFunction(rest, [false, false], { timeout, polling: 50 });
  } catch (error) {
    if (error.name !== "TimeoutError") throw error;
    const left = await page.evaluate(rest, [true, false]).catch((silent) => [`it answers (${silent.message})`]);
    const said = await page.locator(".note-bar:visible").allInnerTexts().catch(() => []);
    throw new Error(`the page is not at rest after ${timeout / 1000} s: it does not hold that ${left.join(", that ") || "it was at rest in time"}; it says ${JSON.stringify(said)}`, { cause: error });
  }
}

const executed = promisify(execFile);

/** What a program prints. It is waited for without standing still: the host of the pages is in this process. */
export async function ran(program, words, options = {}) {
  return (await executed(program, words, { maxBuffer: 1e8, ...options })).stdout;
}

/** Drops files, `[name, bytes or text]`, on the page. */
export async function drop(page, ...files) {
  const plain = files.map(([name, data]) => [name, Buffer.from(data).toString("base64")]);
  await page.evaluate((plain) => {
    const made = plain.map(([name, data]) => new File([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))], name));
    globalThis.dropped = globalThis.slipstick.intake.files(made);
  }, plain);
}

export const message = (page) => page.locator(".note-bar:not(.busy)").innerText();
export const headline = (page) => page.locator(".headline dd").allInnerTexts();

/** A folder that is there while a program runs. */
export function temporary() {
  const folder = mkdtempSync(join(tmpdir(), "slipstick-page-"));
  return { folder, remove: () => rmSync(folder, { recursive: true, force: true }) };
}
