/** The table [motion] of a model's text. */

export interface RecordChoice {
  name: string;
  units?: string;
  dt?: string;
  channel?: string;
}

const quoted = (text: string) => JSON.stringify(text);

/** The text without the table [motion] and those in it; where it stood. */
function without(text: string): { before: string; after: string; body: string } {
  const lines = text.split("\n");
  const kept: string[] = [];
  const body: string[] = [];
  let inside = false;
  let place = -1;
  for (const line of lines) {
    const head = /^\s*\[{1,2}\s*([^\]#]+?)\s*\]{1,2}/.exec(line)?.[1];
    if (head !== undefined) {
      inside = head === "motion" || head.startsWith("motion.");
      if (inside && place < 0) place = kept.length;
    }
    (inside ? body : kept).push(line);
  }
  if (place < 0) place = kept.length;
  return { before: kept.slice(0, place).join("\n"), after: kept.slice(place).join("\n"), body: body.join("\n") };
}

/** The text with another [motion]. */
function withMotion(text: string, motion: string[]): string {
  const { before, after } = without(text);
  const parts = [before.trimEnd(), `[motion]\n${motion.join("\n")}`, after.trim()].filter((part) => part !== "");
  return `${parts.join("\n\n")}\n`;
}

/** The model on a record, as it was recorded or times a factor. */
export function onRecord(text: string, record: RecordChoice, scale = 1): string {
  const lines = [`record = ${quoted(record.name)}`];
  if (record.units) lines.push(`units = ${quoted(record.units)}`);
  if (record.dt) lines.push(`dt = ${quoted(record.dt)}`);
  if (record.channel) lines.push(`channel = ${quoted(record.channel)}`);
  if (scale !== 1) lines.push(`scale = ${scale}`);
  return withMotion(text, lines);
}

const MADE: Record<string, string> = {
  sine: 'sine = { frequency = "1 Hz", amplitude = "2 m/s2", duration = "12 s", dt = "0.005 s", ramp = "2 s" }',
  sweep: 'sweep = { from = "0.5 Hz", to = "5 Hz", kind = "logarithmic", amplitude = "2 m/s2", duration = "30 s", dt = "0.005 s" }',
  pulse: 'pulse = { shape = "half-sine", amplitude = "4 m/s2", duration = "0.5 s", start = "0.2 s", dt = "0.002 s" }',
};

/** The name that an example bears with another motion: what follows its comma is the motion. */
export function renamed(text: string, examples: string[], motion: string): string {
  const line = /^name\s*=\s*"([^",]+), [^"]*"/m;
  const structure = line.exec(text.split(/^\s*\[/m)[0] ?? "")?.[1];
  const known = structure !== undefined && examples.some((example) => line.exec(example)?.[1] === structure);
  return known ? text.replace(line, () => `name = ${quoted(`${structure}, ${motion}`)}`) : text;
}

/** The same model under a made motion, with a tail where it has none. */
export function onMade(text: string, kind: string): string {
  return withMotion(text, [MADE[kind] ?? MADE.sine!]);
}

/** Whether a text is a plan rather than a model: it names a model before its first table. */
export function isPlan(text: string): boolean {
  const top = text.split(/^\s*\[/m)[0] ?? "";
  return /^\s*model\s*=/m.test(top);
}
