/**
 * Serves the site from a cache, so that it works offline after the first load. The build fills in the version and the list of
 * files; nothing but files of this site is ever fetched or kept. What few visitors need (LATER) is kept when it is fetched first.
 */
const CACHE = "ridgeline-__VERSION__";
const FILES = ["__FILES__"];
const LATER = ["__LATER__"];

self.addEventListener("install", (event) => {
  const fill = async () => {
    const cache = await caches.open(CACHE);
    await cache.addAll(FILES);
    await self.skipWaiting();
  };
  event.waitUntil(fill());
});

self.addEventListener("activate", (event) => {
  const replace = async () => {
    const names = await caches.keys();
    const old = names.filter((name) => name.startsWith("ridgeline-") && name !== CACHE);
    await Promise.all(old.map((name) => caches.delete(name)));
    await self.clients.claim();
  };
  event.waitUntil(replace());
});

self.addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method !== "GET" || new URL(request.url).origin !== self.location.origin) {
    return;
  }
  const answer = async () => {
    const cache = await caches.open(CACHE);
    const known = await cache.match(request, { ignoreSearch: true, ignoreVary: true });
    if (known !== undefined) {
      return known;
    }
    const response = await fetch(request);
    const page = new URL(request.url);
    page.hash = "";
    page.search = "";
    if (response.ok && LATER.some((path) => new URL(path, self.registration.scope).href === page.href)) {
      await cache.put(request, response.clone());
    }
    return response;
  };
  event.respondWith(answer());
});
