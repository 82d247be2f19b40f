//! The seabed under points of lines, several at a time.

use catenix_numerics::Vector3;
use catenix_numerics::lanes::{Lane, MOST_LANES, Mat3, Row, Vec3};

use super::frame_kernel::NO_ROW;
use super::frames::Sea;
use crate::contact::seabed;

/// Forces of the seabed, and their derivatives.
pub(crate) struct Touch<T> {
    /// Force [N].
    pub force: Vec3<T>,
    /// By the height [N/m].
    pub by_height: Vec3<T>,
    /// By the velocity [N s/m].
    pub by_velocity: Mat3<T>,
}

impl<T: Lane> Touch<T> {
    /// For points at a height `z` that stand for so much of a line; `None` where no point touches.
    #[inline(always)]
    pub(crate) fn of(
        token: T::Token,
        sea: &Sea<'_>,
        length: T,
        z: T,
        velocity: Vec3<T>,
    ) -> Option<Touch<T>> {
        let own = sea.seabed?;
        let height = z + sea.depth;
        if (-height).all_less(0.0) {
            return None;
        }
        let mut motion = [NO_ROW; 5];
        height.write(&mut motion[0]);
        velocity.write(&mut motion[1..]);
        length.write(&mut motion[4]);
        let mut rows = [NO_ROW; 15];
        points(own, &motion, T::COUNT, &mut rows);
        Some(Touch {
            force: Vec3::read(token, &rows),
            by_height: Vec3::read(token, &rows[3..]),
            by_velocity: Mat3::read(token, &rows[6..]),
        })
    }
}

/// Point by point: from height, velocity and length to force and its derivatives.
#[cold]
#[inline(never)]
fn points(own: &catenix_model::Seabed, motion: &[Row; 5], count: usize, rows: &mut [Row; 15]) {
    for lane in 0..count.min(MOST_LANES) {
        let [height, x, y, z, length] = [0, 1, 2, 3, 4].map(|k: usize| motion[k][lane]);
        let velocity = Vector3::new(x, y, z);
        let Some(touch) = seabed::contact(own, length, height, &velocity) else {
            continue;
        };
        let numbers = touch.force.iter().chain(&touch.by_height);
        for (row, number) in rows.iter_mut().zip(numbers.chain(&touch.by_velocity)) {
            row[lane] = *number;
        }
    }
}
