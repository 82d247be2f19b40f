// What the server tells about a store. The Rust side: crates/results/src/description.rs, scene.rs,
// envelope.rs and crates/viewer/src/routes.rs.

export type Status = "pending" | "running" | "complete" | "interrupted" | "failed";

export interface CaseProgress {
  name: string;
  description: string;
  status: Status;
  history_rows: number;
  field_rows: number;
  duration_s: number | null;
  error: { code: string; message: string } | null;
}

export interface StudyReport {
  title: string;
  note: string;
  model_file: string;
  model_sha256: string;
  catenix_version: string;
  status: Status;
  /** Time since the last write [s]. */
  idle_s: number | null;
  cases: CaseProgress[];
}

/** An array and its chunks: `chunk_rows` x `columns` little-endian floats and a CRC-32C each. */
export interface ArrayPlace {
  path: string;
  data_type: "float32" | "float64";
  rows: number;
  columns: number | null;
  chunk_rows: number;
}

export interface ChannelPlace {
  name: string;
  unit: string;
  array: ArrayPlace;
}

export interface QuantityPlace {
  name: string;
  unit: string;
  long_name: string;
  field: ArrayPlace;
  static_state: ArrayPlace | null;
  has_range_graph: boolean;
}

export interface LinePlace {
  name: string;
  arc_length: ArrayPlace;
  field_time: ArrayPlace;
  quantities: QuantityPlace[];
}

export interface SceneVessel {
  name: string;
  position_m: [number, number, number];
  heading_deg: number;
  moves: boolean;
  /** Null where the model does not say. */
  shape?: "ship" | "platform" | "buoy" | "crawler" | null;
  length_m?: number | null;
}

export interface SceneBody {
  name: string;
  length_m: number;
  volume_m3: number;
  mass_kg: number;
  offset_vessel: string | null;
}

export interface SceneAttachment {
  name: string;
  arc_length_m: number;
  volume_m3: number;
  wet_weight_n: number;
}

export interface SceneLine {
  name: string;
  length_m: number;
  elements: number;
  sections: { line_type: string; end_m: number; outer_diameter_m: number }[];
  attachments: SceneAttachment[];
  ends: ({ to: string; joint: string; point_m: [number, number, number] } | null)[];
}

export interface Scene {
  /** Null without water. */
  water_depth_m: number | null;
  seabed: boolean;
  current: { depth_m: number; velocity_m_s: [number, number] }[];
  current_factor: [number, number][];
  vessels: SceneVessel[];
  bodies: SceneBody[];
  lines: SceneLine[];
}

export interface CaseDescription extends CaseProgress {
  scene: Scene | null;
  window_s: [number, number] | null;
  time: ArrayPlace | null;
  channels: ChannelPlace[];
  lines: LinePlace[];
}

export interface Envelope {
  every_step: boolean;
  window_s: [number, number] | null;
  min: (number | null)[];
  mean: (number | null)[];
  max: (number | null)[];
  run_min: (number | null)[];
  run_max: (number | null)[];
}

export interface NodeHistory {
  unit: string;
  times_s: number[];
  values: (number | null)[];
}
