/** What the page as one file begins with: its scripts stand in it packed. */

import { unpack } from "./packed";

void unpack(document.getElementById("slipstick-app")!.textContent ?? "").then((bytes) => {
  const script = document.createElement("script");
  script.src = URL.createObjectURL(new Blob([bytes], { type: "text/javascript" }));
  document.body.append(script);
});
