// What the page says about the run, the server, and what is missing.

import { ConnectionLost, ServerError } from "../api";
import { title } from "../format";
import type { CaseData } from "../store/case_data";
import type { StudyReport } from "../store/types";
import { banner, clearBanner, say } from "./banners";
import { byId } from "./dom";

/** A run that has not written for this long may be dead [s]. */
const SILENCE_S = 20;

/** Title, state of the run, cases that failed. */
export function tellStudy(study: StudyReport, shown: readonly string[]): void {
  const heading = study.title || study.model_file;
  document.title = `${heading} – Catenix viewer`;
  byId("title").textContent = heading;
  byId("title").title = heading;
  byId("about").textContent =
    `Computed by Catenix ${study.catenix_version} from ${study.model_file} ` +
    `(SHA-256 ${study.model_sha256.slice(0, 12)}…). Licences of what the page uses: licenses.txt.`;
  const words = {
    pending: "Not begun",
    running: "Running",
    complete: "Complete",
    interrupted: "Interrupted",
    failed: "Failed",
  };
  const chip = byId("status");
  if (chip.textContent !== words[study.status]) {
    chip.textContent = words[study.status];
  }
  if (study.status === "running" && (study.idle_s ?? 0) > SILENCE_S) {
    banner(
      "silent",
      "The run has not stored anything for a while. It is at a hard step, or it was ended; what " +
        "is stored is shown.",
    );
  } else {
    clearBanner("silent");
  }
  for (const found of study.cases) {
    const key = `failed ${found.name}`;
    if (found.status === "failed" && shown.includes(found.name)) {
      const reason = found.error?.message ?? "the solver gave up";
      banner(key, `Case ${found.name}: ${reason}. What was stored before is shown.`, true);
    } else {
      clearBanner(key);
    }
  }
}

/** Says in words what the picture shows. */
export function describeScene(cases: CaseData[], quantity: string, time: string): void {
  const names = cases.map((data) => data.name).join(", ");
  const lines = new Set(cases.flatMap((data) => data.description.lines.map((line) => line.name)));
  const label = `Case ${names} at ${time} seconds: lines ${[...lines].join(", ")}, coloured by ${title(quantity).toLowerCase()}`;
  if (byId("canvas").getAttribute("aria-label") !== label) {
    byId("canvas").setAttribute("aria-label", label);
  }
}

/** Says in the scene why there is nothing in it. */
export function tellEmpty(cases: CaseData[], study: StudyReport | null): void {
  const empty = byId("empty");
  if (study?.cases.length === 0) {
    empty.hidden = false;
    empty.textContent = "This store holds no load case. Run the model again.";
    return;
  }
  const words = {
    pending: "has not begun; it appears here as soon as it does",
    running: "has no stored step yet: its static state is being sought",
    complete: "holds no steps",
    interrupted: "was interrupted before its first step",
    failed: "failed before its first step",
  };
  const text = cases
    .filter((data) => !data.hasFrames)
    .map(({ description: { name, status } }) => `Case ${name} ${words[status]}.`)
    .join(" ");
  empty.hidden = text === "" || cases.some((data) => data.hasFrames);
  empty.textContent = text;
}

/** Shows what went wrong. A lost connection has a message of its own. */
export function report(error: unknown): void {
  if (error instanceof ConnectionLost) {
    return;
  }
  if (error instanceof ServerError) {
    const gone = error.code === "results::no_store" || error.code === "results::read";
    const refused = error.code === "viewer::token";
    const text = gone
      ? "The results are gone from the disk, or are being replaced. The page looks again every few seconds."
      : refused
        ? "This address is no longer valid: the viewer was started anew. Open the link that it printed."
        : error.message;
    banner("study", text, true, false);
    return;
  }
  banner("error", `Something went wrong in the page: ${(error as Error).message}`, true);
}

/** The server has gone, or is back. */
export function tellConnection(connected: boolean): void {
  if (connected) {
    clearBanner("connection");
    say("The connection is back.");
  } else {
    banner(
      "connection",
      "The connection to Catenix is lost. What was loaded can still be viewed; the page tries " +
        "again by itself. If the viewer was ended, start it again and open its new link.",
      true,
      false,
    );
  }
}
