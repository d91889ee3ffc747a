// The connection to the server: operations, and things to watch, which survive a lost connection.

import { language, t } from "./language.js";

const RETRY_MS = 1000;

let socket = null;
let nextId = 1;
const calls = new Map(); // id -> {resolve, reject}
const watches = new Set(); // {what, args, onData, onError, number}
const byNumber = new Map(); // server's number -> watch
const early = new Map(); // server's number -> events that overtook the answer
const listeners = new Set();

/** Whether the server is there. */
export function connected() {
  return socket !== null && socket.readyState === WebSocket.OPEN;
}

/** Have `listener(connected, reason)` called now and at each change; the reason is the server's,
 * if it refuses this page. */
export function onConnection(listener) {
  listeners.add(listener);
  listener(connected());
  return () => listeners.delete(listener);
}

/** Ask the server for something; the promise fails with its reason. */
export function call(op, args = {}) {
  if (!connected()) return Promise.reject(new Error(t("not connected", "未连接")));
  const id = nextId++;
  return new Promise((resolve, reject) => {
    calls.set(id, { resolve, reject });
    socket.send(JSON.stringify({ ...args, id, op }));
  });
}

/** Send without waiting for an answer; false if there is no connection. */
export function tell(op, args = {}) {
  if (!connected()) return false;
  socket.send(JSON.stringify({ ...args, id: null, op }));
  return true;
}

/** Have `onData(data)` called for each event, bytes as a DataView, until the result is called. */
export function watch(what, args, onData, onError = console.warn) {
  const one = { what, args: args ?? {}, onData, onError, number: null };
  watches.add(one);
  if (connected()) begin(one);
  return () => {
    watches.delete(one);
    if (one.number !== null) end(one);
  };
}

async function begin(one) {
  try {
    const { watch: number } = await call("watch", { what: one.what, args: one.args });
    one.number = number;
    if (!watches.has(one)) return end(one); // stopped meanwhile
    byNumber.set(number, one);
    const waiting = early.get(number) ?? [];
    early.delete(number);
    waiting.forEach((data) => one.onData(data));
  } catch (error) {
    if (watches.has(one) && connected()) one.onError(error.message);
  }
}

function end(one) {
  byNumber.delete(one.number);
  early.delete(one.number);
  if (connected()) call("unwatch", { watch: one.number }).catch(() => {});
  one.number = null;
}

function deliver(number, data) {
  const one = byNumber.get(number);
  if (one) one.onData(data);
  else if (early.size < 64) early.set(number, [...(early.get(number) ?? []).slice(-99), data]);
}

function take(event) {
  if (event.data instanceof ArrayBuffer) {
    deliver(new DataView(event.data).getUint32(0, true), new DataView(event.data, 4));
    return;
  }
  const message = JSON.parse(event.data);
  if ("watch" in message) {
    deliver(message.watch, message.data);
    return;
  }
  const waiting = calls.get(message.id);
  calls.delete(message.id);
  if (waiting && message.ok) waiting.resolve(message.data);
  else if (waiting) waiting.reject(new Error(message.error));
}

function connect() {
  const address = new URL(`ws${location.search}`, location.href); // beside the page, also behind a proxy
  address.protocol = location.protocol === "https:" ? "wss" : "ws";
  if (language === "zh") address.searchParams.set("language", "zh_CN");
  socket = new WebSocket(address);
  socket.binaryType = "arraybuffer";
  socket.onmessage = take;
  socket.onopen = () => {
    listeners.forEach((listener) => listener(true));
    watches.forEach(begin);
  };
  socket.onclose = () => {
    calls.forEach(({ reject }) => reject(new Error(t("the connection was lost", "连接已断开"))));
    calls.clear();
    byNumber.clear();
    early.clear();
    watches.forEach((one) => (one.number = null));
    tellLost();
    setTimeout(connect, RETRY_MS);
  };
}

/** A browser does not say why a connection was refused; the page itself would be told. */
async function tellLost() {
  listeners.forEach((listener) => listener(false, ""));
  const answer = await fetch(location.href, { cache: "no-store" }).catch(() => null);
  if (answer?.status !== 403 || connected()) return;
  const reason = (await answer.text()).trim();
  listeners.forEach((listener) => listener(false, reason));
}

connect();
