// Colours, apart for the colour-blind too (Okabe and Ito 2008). [r, g, b] from 0 to 1.

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
const all = (colors) => Object.fromEntries(Object.entries(colors).map(([name, hex]) => [name, rgb(hex)]));

export const THEMES = {
  dark: all({
    back: "#0a0e14", free: "#161e28", wall: "#a9d3f2", motion: "#c8761a", grid: "#5b7590",
    stationary: "#56b4e9", moving: "#ff9d2e", unknown: "#f0e442", unlabelled: "#8894a0",
    vehicle: "#ffffff", way: "#4cc9a5", graph: "#7a8ea3", accepted: "#35d0a0", rejected: "#e2643c", withdrawn: "#f0e442",
    car: "#f5a623", truck: "#e2643c", pedestrian: "#e08fc0", bicycle: "#2fc99b", other: "#aab6c2", scan: "#56b4e9",
  }),
  light: all({
    back: "#e9edf1", free: "#ffffff", wall: "#24405e", motion: "#f0b25a", grid: "#8fa2b5",
    stationary: "#0072b2", moving: "#d55e00", unknown: "#9a8f00", unlabelled: "#77818b",
    vehicle: "#111820", way: "#008f6c", graph: "#8796a6", accepted: "#00865f", rejected: "#c03a12", withdrawn: "#8a7d00",
    car: "#c47a00", truck: "#b8431b", pedestrian: "#a83f80", bicycle: "#007a58", other: "#5d6a76", scan: "#0072b2",
  }),
};

export const CLASSES = {
  car: "car", "truck or bus": "truck", pedestrian: "pedestrian", bicycle: "bicycle", unknown: "other",
};

export const css = (color, alpha = 1) => `rgba(${color.map((part) => Math.round(part * 255)).join(",")},${alpha})`;
