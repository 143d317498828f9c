/** Keeps the page's files, so that it opens without a network; another version replaces them all. */

declare const SLIPSTICK_FILES: string[];
declare const SLIPSTICK_BUILD: string;

const scope = globalThis as unknown as ServiceWorkerGlobalScope;
const store = `slipstick-${SLIPSTICK_BUILD}`;

scope.addEventListener("install", (event) => {
  event.waitUntil(
    caches
      .open(store)
      .then((cache) => cache.addAll(SLIPSTICK_FILES))
      .then(() => scope.skipWaiting()),
  );
});

scope.addEventListener("activate", (event) => {
  const clean = async () => {
    for (const name of await caches.keys()) {
      if (name.startsWith("slipstick-") && name !== store) await caches.delete(name);
    }
    await scope.clients.claim();
  };
  event.waitUntil(clean());
});

scope.addEventListener("fetch", (event) => {
  if (event.request.method !== "GET" || new URL(event.request.url).origin !== scope.location.origin) return;
  const answer = async () => (await caches.match(event.request, { ignoreSearch: true })) ?? fetch(event.request);
  event.respondWith(answer());
});
