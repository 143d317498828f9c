/** The animation as a film, with its title and the time on it. */

import { h } from "./dom";
import type { Stage } from "./stage";

const KINDS = ["video/webm;codecs=vp9", "video/webm", "video/mp4"];
const [WIDTH, TOP] = [960, 44];

/** Records the animation from one instant to another as it plays, as long as it is the same one; `undefined` where the browser makes no films. */
export async function film(stage: Stage, title: string, [from, to]: [number, number], same: () => boolean): Promise<{ blob: Blob; ending: string } | undefined> {
  const kind = globalThis.MediaRecorder && KINDS.find((kind) => MediaRecorder.isTypeSupported(kind));
  if (!kind) return undefined;
  const { canvas } = stage;
  const height = TOP + Math.round((WIDTH * canvas.height) / Math.max(1, canvas.width));
  const sheet = h("canvas", { width: WIDTH, height: height + (height % 2) });
  const c = sheet.getContext("2d")!;
  const style = getComputedStyle(canvas);
  const draw = () => {
    c.fillStyle = style.getPropertyValue("--panel") || "#fff";
    c.fillRect(0, 0, sheet.width, sheet.height);
    c.drawImage(canvas, 0, TOP, WIDTH, height - TOP);
    c.fillStyle = style.getPropertyValue("--ink") || "#000";
    c.font = "600 18px system-ui, sans-serif";
    c.fillText(title, 14, 28, WIDTH - 130);
    c.font = "18px system-ui, sans-serif";
    c.textAlign = "right";
    c.fillText(`${stage.time.toFixed(2)} s`, WIDTH - 14, 28);
    c.textAlign = "left";
  };
  const recorder = new MediaRecorder(sheet.captureStream(30), { mimeType: kind, videoBitsPerSecond: 4_000_000 });
  const parts: Blob[] = [];
  recorder.addEventListener("dataavailable", (event) => parts.push(event.data));
  const ended = new Promise((done) => recorder.addEventListener("stop", done));
  const before = stage.playing;
  stage.seek(from);
  stage.play(true);
  recorder.start(500);
  const started = performance.now();
  const most = (1000 * (to - from)) / stage.speed + 1000;
  let last = from;
  await new Promise<void>((done) => {
    const step = () => {
      draw();
      // It starts anew at its end.
      const over = stage.time >= to || stage.time < last - 1e-9 || performance.now() - started > most || !stage.playing || !same();
      last = stage.time;
      if (over) done();
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  });
  recorder.stop();
  await ended;
  stage.play(before);
  return { blob: new Blob(parts, { type: kind }), ending: kind.includes("mp4") ? "mp4" : "webm" };
}
