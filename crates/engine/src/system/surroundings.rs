//! The sea around frames, several at a time: how much of them is under water, and how it flows there.

use catenix_numerics::lanes::{Lane, Row, Vec3};

use super::frame_kernel::{NO_ROW, fill};
use super::frames::Sea;
use crate::hydro::submergence::Submergence;

/// What is felt of the sea at the heights of frames.
pub(crate) struct Surroundings<T> {
    /// Velocity of the water [m/s] and its derivative by height [1/s].
    pub water: [Vec3<T>; 2],
    /// Share under water, its derivative by height, and by the slope of the axis (3).
    pub wet: [T; 3],
    /// Whether one of the frames passes through the surface.
    pub at_surface: bool,
}

impl<T: Lane> Surroundings<T> {
    /// For frames of some length and diameter [m], at a height [m], whose axes rise by `slope`.
    #[inline(always)]
    pub(crate) fn new(
        token: T::Token,
        rows: &[Row; 2],
        sea: &Sea<'_>,
        height: T,
        slope: T,
    ) -> Self {
        let size = [T::read(token, &rows[0]), T::read(token, &rows[1])];
        // Nearly always all of them are under water, and in one piece of the current's profile.
        let top = (size[0] * slope.abs() + size[1]).mul_add(height.same(0.5), height);
        let zero = T::splat(token, 0.0);
        let (wet, at_surface) = if top.all_less(0.0) {
            ([T::splat(token, 1.0), zero, zero], false)
        } else {
            Self::shares(token, rows, height, slope)
        };
        Surroundings {
            water: water(token, sea, height),
            wet,
            at_surface,
        }
    }

    /// Shares under water and their derivatives, frame by frame.
    #[inline(always)]
    fn shares(token: T::Token, size: &[Row; 2], height: T, slope: T) -> ([T; 3], bool) {
        let (mut heights, mut slopes, mut rows) = (NO_ROW, NO_ROW, [NO_ROW; 3]);
        height.write(&mut heights);
        slope.write(&mut slopes);
        let mut at_surface = false;
        for lane in 0..T::COUNT {
            let [length, diameter] = [size[0][lane], size[1][lane]];
            let wet = Submergence::new(heights[lane], slopes[lane], length, diameter);
            fill(&mut rows, lane, &[wet.share, wet.by_height, wet.by_slope]);
            at_surface |= wet.by_height != 0.0;
        }
        let wet = [
            T::read(token, &rows[0]),
            T::read(token, &rows[1]),
            T::read(token, &rows[2]),
        ];
        (wet, at_surface)
    }
}

/// Velocity of the water at some heights, and its derivative by height.
#[inline(always)]
fn water<T: Lane>(token: T::Token, sea: &Sea<'_>, height: T) -> [Vec3<T>; 2] {
    let mut heights = NO_ROW;
    height.write(&mut heights);
    let zero = T::splat(token, 0.0);
    let factor = sea.current_factor;
    let piece = sea.current.piece(heights[0]);
    let inside = (height - T::splat(token, piece.top)).all_less(0.0)
        && (T::splat(token, piece.bottom) - height).all_less(0.0);
    if inside {
        let [x, y] = piece.slope;
        let [x, y] = [T::splat(token, x * factor), T::splat(token, y * factor)];
        let [u, v] = piece.velocity;
        let [u, v] = [T::splat(token, u * factor), T::splat(token, v * factor)];
        let above = height - piece.height;
        return [
            Vec3::new(x.mul_add(above, u), y.mul_add(above, v), zero),
            Vec3::new(x, y, zero),
        ];
    }
    let mut rows = [NO_ROW; 6];
    for (lane, height) in heights[..T::COUNT].iter().enumerate() {
        let (water, slope) = sea.current.at(*height, factor);
        fill(&mut rows, lane, water.as_slice());
        fill(&mut rows[3..], lane, slope.as_slice());
    }
    [Vec3::read(token, &rows), Vec3::read(token, &rows[3..])]
}
