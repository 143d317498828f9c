"use strict";
// The values of the lines under the pointer, read off the drawing. The page is complete without it.
(() => {
  const tip = document.createElement("div");
  tip.className = "hover";
  tip.hidden = true;
  document.body.append(tip);
  const numbers = (text) => (text.match(/-?\d+(\.\d+)?(e-?\d+)?/g) || []).map(Number);
  const shown = (value) => String(Number(value.toPrecision(4))).replace("-", "\u2212");
  const scaled = ([min, max, logarithmic], part) => (logarithmic ? min * (max / min) ** part : min + (max - min) * part);
  const heights = new Map();
  const height = (line, x) => {
    if (!heights.has(line)) heights.set(line, numbers(line.getAttribute("d")));
    const points = heights.get(line);
    for (let i = 2; i + 1 < points.length; i += 2) {
      const [x0, y0, x1, y1] = points.slice(i - 2, i + 2);
      if (x0 <= x && x <= x1) return x1 > x0 ? y0 + ((y1 - y0) * (x - x0)) / (x1 - x0) : y1;
    }
    return undefined;
  };
  const words = (svg, x, y) => {
    for (const panel of svg.querySelectorAll("[data-frame]")) {
      const [left, top, width, tall] = numbers(panel.dataset.frame);
      if (x < left || x > left + width || y < top || y > top + tall) continue;
      const said = [`${panel.dataset.label}: ${shown(scaled(numbers(panel.dataset.x), (x - left) / width))}`];
      for (const line of panel.querySelectorAll("[data-line]")) {
        const at = height(line, x);
        const name = line.dataset.line || panel.dataset.quantity;
        if (at !== undefined) said.push(`${name}: ${shown(scaled(numbers(panel.dataset.y), 1 - (at - top) / tall))}`);
      }
      return said.length > 1 ? said.join("\n") : "";
    }
    return "";
  };
  for (const svg of document.querySelectorAll("figure svg[role]")) {
    svg.addEventListener("pointermove", (event) => {
      const to = svg.getScreenCTM();
      tip.textContent = words(svg, (event.clientX - to.e) / to.a, (event.clientY - to.f) / to.d);
      tip.hidden = tip.textContent === "";
      const right = event.clientX > 0.6 * innerWidth;
      tip.style.left = right ? "" : `${event.clientX + 14}px`;
      tip.style.right = right ? `${innerWidth - event.clientX + 14}px` : "";
      tip.style.top = `${event.clientY + 14}px`;
    });
    svg.addEventListener("pointerleave", () => (tip.hidden = true));
  }
})();
