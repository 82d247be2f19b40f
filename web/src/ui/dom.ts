// Small helpers for the page.

export function byId<T extends HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (!element) {
    throw new Error(`the page has no element ${id}`);
  }
  return element as T;
}

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  text = "",
  attributes: Record<string, string> = {},
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  element.textContent = text;
  for (const [name, value] of Object.entries(attributes)) {
    element.setAttribute(name, value);
  }
  return element;
}

/** Replaces the entries of a list, keeping the choice where it still exists. */
export function fill(
  select: HTMLSelectElement,
  groups: { label: string; entries: [value: string, text: string][] }[],
  chosen: string,
): void {
  const key = JSON.stringify(groups);
  if (select.dataset.key !== key) {
    select.dataset.key = key;
    select.replaceChildren(
      ...groups.flatMap(({ label, entries }) => {
        const options = entries.map(([value, text]) => make("option", text, { value }));
        if (!label) {
          return options;
        }
        const group = make("optgroup", "", { label });
        group.append(...options);
        return [group];
      }),
    );
  }
  if (select.value !== chosen) {
    select.value = chosen;
  }
}

/** A colour of the theme. */
export function themeColour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Offers a file for download. */
export function save(blob: Blob, name: string): void {
  const link = make("a", "", { download: name, href: URL.createObjectURL(blob) });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
