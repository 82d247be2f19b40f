// Colour maps: perceptually uniform and readable with any colour vision.

export type MapName = "viridis" | "cividis" | "diverging" | "grey";

// Control points, evenly spaced. viridis: S. van der Walt, N. Smith (CC0); cividis: J. Nuñez,
// C. Anderton, R. Renslow, PLOS ONE 13 (2018) e0199239; diverging: a blue-white-orange ramp whose
// two ends are equally dark.
const POINTS: Record<MapName, string[]> = {
  viridis: [
    "440154", "481f70", "443983", "3b528b", "31688e", "287c8e", "21918c", "20a486", "35b779",
    "5ec962", "90d743", "c8e020", "fde725",
  ],
  cividis: [
    "00224e", "123570", "3b496c", "575d6d", "707173", "8a8678", "a59c74", "c3b369", "e1cc55",
    "fee838",
  ],
  diverging: ["2166ac", "5aa2cf", "b5d7e8", "f2f2f2", "f6c9a0", "e08a45", "b35806"],
  grey: ["1c1c1c", "f0f0f0"],
};

// Colours of the load cases (Okabe and Ito, M. Okabe and K. Ito, Color Universal Design, 2008, in an
// order that keeps neighbours apart; darker on light ground and lighter on dark ground, so that each
// has a contrast of 3 to its ground).
const ON_LIGHT = [
  "#0072b2", "#b87800", "#008c66", "#b9568a", "#c04f00", "#2b87bb", "#7d5aa6", "#867b00",
];
const ON_DARK = [
  "#5fb2ea", "#f0b13c", "#2fc49a", "#e39ac4", "#f0813c", "#9bd4f5", "#b79bdb", "#d3c53a",
];
/** Dashes of their curves [px]: nothing is told apart by colour alone. */
const DASHES = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 2], [12, 5], [2, 2, 6, 2], [1, 4]];

/** The colour of a load case by its place among the shown ones. */
export function caseColour(index: number): string {
  const dark = document.documentElement.hasAttribute("data-dark");
  const colours = dark ? ON_DARK : ON_LIGHT;
  return colours[Math.max(index, 0) % colours.length];
}

/** The dashes of a load case's curves. */
export function caseDash(index: number): number[] {
  return DASHES[Math.max(index, 0) % DASHES.length];
}

/** 256 colours of a map, RGBA bytes. */
export function mapBytes(name: MapName): Uint8Array {
  const points = POINTS[name].map(rgb);
  const bytes = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; i++) {
    const at = (i / 255) * (points.length - 1);
    const k = Math.min(Math.floor(at), points.length - 2);
    for (let c = 0; c < 3; c++) {
      bytes[4 * i + c] = Math.round(points[k][c] + (at - k) * (points[k + 1][c] - points[k][c]));
    }
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}

/** A colour as three bytes. */
export function rgb(hex: string): [number, number, number] {
  const value = parseInt(hex.replace("#", ""), 16);
  return [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}

/** Colours of the scene in the light and the dark theme. */
export interface Palette {
  top: string;
  bottom: string;
  ink: string;
  faint: string;
  halo: string;
  sea: string;
  seabed: string;
  seabedGrid: string;
  outline: string;
  current: string;
  hull: string;
  topside: string;
  deck: string;
  house: string;
  derrick: string;
  body: string;
  float: string;
  weight: string;
  mark: string;
}

export const LIGHT: Palette = {
  top: "#eef5fa",
  bottom: "#cfe0ec",
  ink: "#13293a",
  faint: "#51687a",
  halo: "#f4f9fc",
  sea: "#2b7fb8",
  seabed: "#b99b6b",
  seabedGrid: "#6f5a36",
  outline: "#1b2d3a",
  current: "#00655e",
  hull: "#a93226",
  topside: "#27496b",
  deck: "#6f8f80",
  house: "#f4f1ea",
  derrick: "#d98a1f",
  body: "#e8a33d",
  float: "#e8702a",
  weight: "#4a5560",
  mark: "#c2185b",
};

export const DARK: Palette = {
  top: "#12222f",
  bottom: "#081018",
  ink: "#e8f1f7",
  faint: "#a3b7c6",
  halo: "#0b151d",
  sea: "#4aa8e0",
  seabed: "#8a744f",
  seabedGrid: "#d3bb8c",
  outline: "#dce8f0",
  current: "#5fd6c8",
  hull: "#cf5646",
  topside: "#5b86b0",
  deck: "#7f9c8f",
  house: "#eef1f2",
  derrick: "#f0a540",
  body: "#f0b350",
  float: "#ff8a45",
  weight: "#9aa7b2",
  mark: "#ff6ea8",
};
