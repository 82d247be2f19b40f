// Messages that must not be missed: lost connection, damaged data, failed cases.

import { byId, make } from "./dom";

const shown = new Map<string, HTMLElement>();

/** Shows a message under a key; the same key replaces it. */
export function banner(key: string, text: string, bad = false, dismissable = true): void {
  let element = shown.get(key);
  if (element?.dataset.text === text) {
    return;
  }
  element?.remove();
  element = make("div", "", { class: bad ? "banner bad" : "banner", "data-key": key });
  element.dataset.text = text;
  element.append(make("span", text));
  if (dismissable) {
    const close = make("button", "Dismiss", { type: "button" });
    close.addEventListener("click", () => clearBanner(key));
    element.append(close);
  }
  shown.set(key, element);
  byId("banners").append(element);
}

export function clearBanner(key: string): void {
  shown.get(key)?.remove();
  shown.delete(key);
}

/** Tells a screen reader something, politely. */
export function say(text: string): void {
  byId("live").textContent = text;
}
