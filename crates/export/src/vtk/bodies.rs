//! Vessels and bodies as points with an orientation, out of the histories of their channels.

use std::borrow::Cow;

use super::poly_data::{Cells, Data, DataArray, PolyData};
use crate::ExportError;
use crate::contents::CaseContents;

/// Where every vessel and body is at the wanted times.
pub(crate) struct BodyPoints {
    names: Vec<String>,
    /// 0 for a vessel or anchor, 1 for a body.
    kinds: Vec<i32>,
    cell_ends: Vec<i64>,
    /// Per object and time.
    poses: Vec<Vec<Pose>>,
}

/// A position and an orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pose {
    /// Global (3) [m].
    position_m: [f64; 3],
    /// From local to global axes, scalar first (4) [-].
    quaternion: [f64; 4],
}

impl BodyPoints {
    /// Reads the histories. Objects whose channels are not all stored are left out.
    pub(crate) fn read(contents: &CaseContents) -> Result<Self, ExportError> {
        let mut points = BodyPoints {
            names: Vec::new(),
            kinds: Vec::new(),
            cell_ends: Vec::new(),
            poses: Vec::new(),
        };
        let (Some(scene), Some(time)) = (&contents.description.scene, &contents.description.time)
        else {
            return Ok(points);
        };
        let count = contents.description.progress.history_rows.min(time.rows);
        if count == 0 {
            return Ok(points);
        }
        let rows: Vec<usize> = (0..count).collect();
        let times = contents.stored.history_time()?.read(&rows)?;
        let places: Vec<Place> = contents
            .field_times_s
            .iter()
            .map(|time| Place::of(*time, &times))
            .collect();
        // Of long histories only the rows about the wanted times are kept.
        let about = places.iter().flat_map(|place| match place.share {
            0.0 => place.row..place.row + 1,
            _ => place.row..place.row + 2,
        });
        let mut rows: Vec<usize> = about.collect();
        rows.sort_unstable();
        rows.dedup();
        let vessels = scene.vessels.iter().map(|vessel| (&vessel.name, 0));
        let bodies = scene.bodies.iter().map(|body| (&body.name, 1));
        for (name, kind) in vessels.chain(bodies) {
            let channels = ["x", "y", "z", "roll", "pitch", "heading"]
                .map(|quantity| format!("{name}.{quantity}"));
            let known = &contents.description.channels;
            let is_stored = |channel: &String| known.iter().any(|known| known.name == *channel);
            if !channels.iter().all(is_stored) {
                continue;
            }
            let mut histories = Vec::new();
            for channel in &channels {
                histories.push(contents.stored.channel_rows(channel)?.read(&rows)?);
            }
            let pose = |row: usize| -> Pose {
                let kept = rows.partition_point(|kept| *kept < row);
                let value = |channel: usize| histories[channel][kept];
                Pose {
                    position_m: [value(0), value(1), value(2)],
                    quaternion: quaternion([value(3), value(4), value(5)]),
                }
            };
            let poses = places.iter().map(|place| match place.share {
                0.0 => pose(place.row),
                share => between(pose(place.row), pose(place.row + 1), share),
            });
            points.poses.push(poses.collect());
            points.names.push(name.clone());
            points.kinds.push(kind);
            points.cell_ends.push(points.names.len() as i64);
        }
        Ok(points)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// The objects at one of the wanted times.
    pub(crate) fn poly_data(&self, time: usize, time_s: f64) -> PolyData<'_> {
        let at_time = || self.poses.iter().map(|poses| &poses[time]);
        let values = |value: &dyn Fn(&Pose) -> Vec<f64>| {
            Data::Float64(Cow::Owned(at_time().flat_map(value).collect()))
        };
        let vector = |name, data| DataArray {
            name,
            components: 3,
            data,
        };
        PolyData {
            time_s,
            points: values(&|pose| pose.position_m.to_vec()),
            cells: Cells::Vertices,
            cell_ends: &self.cell_ends,
            point_arrays: vec![
                DataArray {
                    name: "quaternion_wxyz",
                    components: 4,
                    data: values(&|pose| pose.quaternion.to_vec()),
                },
                vector("local_x", values(&|pose| axis(pose, 0).to_vec())),
                vector("local_y", values(&|pose| axis(pose, 1).to_vec())),
                vector("local_z", values(&|pose| axis(pose, 2).to_vec())),
                DataArray::scalars("is_body", Data::Int32(Cow::Borrowed(&self.kinds))),
                DataArray::scalars("name", Data::Text(&self.names)),
            ],
            cell_arrays: Vec::new(),
            shown_first: None,
        }
    }
}

/// Where a time lies among the stored ones.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    row: usize,
    /// Share of the way to the next row; 0 at a stored time.
    share: f64,
}

impl Place {
    /// Times outside of the stored ones are moved to the nearest.
    fn of(time_s: f64, times_s: &[f64]) -> Self {
        let slack = 1e-9 * time_s.abs().max(1.0);
        let next = times_s.partition_point(|stored| *stored < time_s - slack);
        if next >= times_s.len() {
            let row = times_s.len().saturating_sub(1);
            return Place { row, share: 0.0 };
        }
        if next == 0 || times_s[next] <= time_s + slack {
            return Place {
                row: next,
                share: 0.0,
            };
        }
        let (before, after) = (times_s[next - 1], times_s[next]);
        Place {
            row: next - 1,
            share: (time_s - before) / (after - before),
        }
    }
}

/// The quaternion of R = Rz(heading) Ry(pitch) Rx(roll), out of roll, pitch and heading [deg].
fn quaternion(angles_deg: [f64; 3]) -> [f64; 4] {
    let half = angles_deg.map(|angle| (0.5 * angle.to_radians()).sin_cos());
    let [(s_roll, c_roll), (s_pitch, c_pitch), (s_heading, c_heading)] = half;
    [
        c_heading * c_pitch * c_roll + s_heading * s_pitch * s_roll,
        c_heading * c_pitch * s_roll - s_heading * s_pitch * c_roll,
        c_heading * s_pitch * c_roll + s_heading * c_pitch * s_roll,
        s_heading * c_pitch * c_roll - c_heading * s_pitch * s_roll,
    ]
}

/// Linear in the position; along the shorter way in the orientation. Over one output interval the
/// angle is small, so that the normalised chord stands for the arc.
fn between(a: Pose, b: Pose, share: f64) -> Pose {
    let mix = |a: f64, b: f64| a + share * (b - a);
    let dot: f64 = (0..4).map(|i| a.quaternion[i] * b.quaternion[i]).sum();
    let sign = if dot < 0.0 { -1.0 } else { 1.0 };
    let chord: [f64; 4] = std::array::from_fn(|i| mix(a.quaternion[i], sign * b.quaternion[i]));
    let norm = chord.iter().map(|part| part * part).sum::<f64>().sqrt();
    Pose {
        position_m: std::array::from_fn(|i| mix(a.position_m[i], b.position_m[i])),
        quaternion: chord.map(|part| part / norm),
    }
}

/// A local axis in global components.
fn axis(pose: &Pose, axis: usize) -> [f64; 3] {
    let [w, x, y, z] = pose.quaternion;
    match axis {
        0 => [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y + w * z),
            2.0 * (x * z - w * y),
        ],
        1 => [
            2.0 * (x * y - w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z + w * x),
        ],
        _ => [
            2.0 * (x * z + w * y),
            2.0 * (y * z - w * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of a handful of products of numbers up to 1.
    const ROUNDING: f64 = 1e-15;

    fn pose(angles_deg: [f64; 3]) -> Pose {
        Pose {
            position_m: [0.0; 3],
            quaternion: quaternion(angles_deg),
        }
    }

    #[test]
    fn the_axes_are_the_columns_of_the_rotation_matrix() {
        let [roll, pitch, heading] = [20.0_f64, -35.0, 130.0];
        let pose = pose([roll, pitch, heading]);
        let (sr, cr) = roll.to_radians().sin_cos();
        let (sp, cp) = pitch.to_radians().sin_cos();
        let (sh, ch) = heading.to_radians().sin_cos();
        // Rz Ry Rx, multiplied out.
        let columns = [
            [ch * cp, sh * cp, -sp],
            [ch * sp * sr - sh * cr, sh * sp * sr + ch * cr, cp * sr],
            [ch * sp * cr + sh * sr, sh * sp * cr - ch * sr, cp * cr],
        ];
        for (index, column) in columns.iter().enumerate() {
            for (found, wanted) in axis(&pose, index).iter().zip(column) {
                assert!((found - wanted).abs() < ROUNDING, "axis {index}");
            }
        }
    }

    #[test]
    fn between_two_poses_the_shorter_way_is_taken() {
        let middle = between(pose([0.0, 0.0, 179.0]), pose([0.0, 0.0, -179.0]), 0.5);
        let [x, y, z] = axis(&middle, 0);
        assert!((x + 1.0).abs() < ROUNDING && y.abs() < ROUNDING && z == 0.0);
    }

    #[test]
    fn stored_times_are_taken_as_they_are() {
        let times = [0.0, 0.1, 0.2, 0.30000000000000004];
        let place = |time| Place::of(time, &times);
        assert_eq!(place(0.3), Place { row: 3, share: 0.0 });
        assert_eq!(place(0.0), Place { row: 0, share: 0.0 });
        assert_eq!(place(9.0), Place { row: 3, share: 0.0 });
        let half = place(0.15);
        assert!(half.row == 1 && (half.share - 0.5).abs() < 1e-12);
    }
}
