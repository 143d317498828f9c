/** The page as one file: module and worker stand in it. */

import { App } from "./app";
import { packed } from "./packed";

const engine = packed((id) => document.getElementById(id)?.textContent ?? "");
const app = new App(document.body, engine, { address: true });
Object.assign(globalThis, { slipstick: app });
