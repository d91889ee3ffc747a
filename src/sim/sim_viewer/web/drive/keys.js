// Keys by their place on the keyboard, so that WASD is one block on every layout.

const DIRECTIONS = { // forward, turn to the left
  KeyW: [1, 0], ArrowUp: [1, 0], KeyS: [-1, 0], ArrowDown: [-1, 0],
  KeyA: [0, 1], ArrowLeft: [0, 1], KeyD: [0, -1], ArrowRight: [0, -1],
};

const isForm = (target) => ["INPUT", "SELECT", "TEXTAREA"].includes(target.tagName);

/** Drive by keyboard until the returned function is called. */
export function listenToKeys(handle) {
  const down = new Set();
  const ending = new AbortController();
  const listen = (target, type, listener) =>
    target.addEventListener(type, listener, { signal: ending.signal });

  const update = () => {
    const wished = [...down].map((code) => DIRECTIONS[code]);
    if (wished.length === 0) handle.letGo("keys");
    else handle.hold("keys", ...[0, 1].map((i) => wished.reduce((sum, one) => sum + one[i], 0)));
  };
  const drop = (reason) => {
    down.clear();
    handle.drop(reason);
    handle.letGo("keys"); // those that are down send no more keydown that would count
  };

  listen(window, "keydown", (event) => {
    if (event.code === "Space" && (handle.holding || !isForm(event.target))) {
      event.preventDefault(); // or it would press the button that was clicked last, such as reset
      return drop("space");
    }
    if (!(event.code in DIRECTIONS) || isForm(event.target)) return;
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault(); // arrows would scroll
    if (event.repeat) return; // held since before a stop
    down.add(event.code);
    update();
  });
  listen(window, "keyup", (event) => {
    if (down.delete(event.code)) update();
  });
  // The keyup of a key held in another window never comes here.
  listen(window, "blur", () => drop("blur"));
  listen(window, "pagehide", () => drop("hidden"));
  listen(document, "visibilitychange", () => document.hidden && drop("hidden"));
  return () => {
    ending.abort();
    drop("closed");
  };
}
