// The page: brings the store, the scene, the graphs and the controls together.

import "./app.css";
import "uplot/dist/uPlot.min.css";
import { App } from "./app";
import { banner } from "./ui/banners";

try {
  new App().start();
} catch (error) {
  const message = (error as Error).message;
  const webgl = /webgl/i.test(message);
  banner("start", webgl ? "This browser does not offer WebGL, so the scene cannot be drawn. Turn on hardware acceleration or use another browser." : `The page could not start: ${message}`, true, false);
}
