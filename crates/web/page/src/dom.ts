/** Small help with elements. Text is text: nothing here takes HTML. */

type Child = Node | string | number | null | undefined | false;
type Attributes = Record<string, string | number | boolean | null | undefined | ((event: never) => void)>;

export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") {
      element.addEventListener(name.replace(/^on/, ""), value as EventListener);
    } else {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
  element.append(...children.filter((c): c is Node | string | number => c !== null && c !== undefined && c !== false).map((c) => (typeof c === "number" ? String(c) : c)));
  return element;
}

/** Replaces what is in an element. */
export function fill(element: Element, ...children: Child[]): void {
  element.replaceChildren(...children.filter((c): c is Node | string => c !== null && c !== undefined && c !== false).map((c) => (typeof c === "number" ? String(c) : c)));
}

/** An SVG drawing of the report as an image: what is in it cannot act. */
export function drawing(svg: string, caption: string): HTMLImageElement {
  const url = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
  const image = h("img", { src: url, alt: caption, class: "drawing" });
  image.addEventListener("load", () => URL.revokeObjectURL(url), { once: true });
  return image;
}

/** Hands a file to the person. */
export function download(name: string, data: BlobPart, type: string): void {
  const url = URL.createObjectURL(new Blob([data], { type }));
  const link = h("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

/** Four significant digits with a true minus sign. */
export function digits(value: number, count = 4): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  const text = size >= 6 || size < -5 ? value.toExponential(count - 1) : value.toFixed(Math.max(0, count - 1 - size));
  return text.replace("-", "−");
}

/** Hands a drawing over as a picture, three times as large as it is. */
export async function picture(svg: string, name: string): Promise<void> {
  const image = drawing(svg, "");
  await image.decode();
  const [, width = "800", height = "400"] = /viewBox="\S+ \S+ ([\d.]+) ([\d.]+)"/.exec(svg) ?? [];
  const canvas = h("canvas", { width: Math.round(Number(width) * 3), height: Math.round(Number(height) * 3) });
  const c = canvas.getContext("2d")!;
  c.fillStyle = "#fff";
  c.fillRect(0, 0, canvas.width, canvas.height);
  c.drawImage(image, 0, 0, canvas.width, canvas.height);
  await savePng(canvas, name);
}

/** Hands a canvas over as a picture. */
export function savePng(canvas: HTMLCanvasElement, name: string): Promise<void> {
  return new Promise((done) =>
    canvas.toBlob((blob) => {
      if (blob) download(name, blob, "image/png");
      done();
    }),
  );
}
