//! Thins curves that have more points than a figure has room for.

/// A point, in any unit.
type Point = (f64, f64);

/// Keeps, in each of `buckets` stretches of the curve, the first and last point and those that lie
/// furthest left, right, down and up. What is left draws the same picture, extremes included. NaN
/// points are kept: they are gaps.
pub(crate) fn decimate(points: &[Point], buckets: usize) -> Vec<Point> {
    if points.len() <= 6 * buckets {
        return points.to_vec();
    }
    let size = points.len().div_ceil(buckets.max(1));
    let mut kept = Vec::with_capacity(6 * buckets);
    for bucket in points.chunks(size) {
        let across = |a: &usize, b: &usize| bucket[*a].0.total_cmp(&bucket[*b].0);
        let up = |a: &usize, b: &usize| bucket[*a].1.total_cmp(&bucket[*b].1);
        let all = || 0..bucket.len();
        let gaps = all().filter(|index| !(bucket[*index].0 + bucket[*index].1).is_finite());
        let mut indices: Vec<usize> = [
            Some(0),
            all().min_by(across),
            all().max_by(across),
            all().min_by(up),
            all().max_by(up),
            Some(bucket.len() - 1),
        ]
        .into_iter()
        .flatten()
        .chain(gaps.take(1))
        .collect();
        indices.sort_unstable();
        indices.dedup();
        kept.extend(indices.into_iter().map(|index| bucket[index]));
    }
    kept
}

/// Leaves out points of a line that lie within `tolerance` of it without them (Ramer 1972, Douglas
/// and Peucker 1973). The outermost points stay, so that extremes are exact.
pub(crate) fn simplify(points: &[Point], tolerance: f64) -> Vec<Point> {
    let Some(last) = points.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut keep = vec![false; points.len()];
    let by = |a: &usize, b: &usize, axis: fn(&Point) -> f64| {
        axis(&points[*a]).total_cmp(&axis(&points[*b]))
    };
    let x: fn(&Point) -> f64 = |point| point.0;
    let y: fn(&Point) -> f64 = |point| point.1;
    let all = || 0..points.len();
    let outermost = [
        Some(0),
        all().min_by(|a, b| by(a, b, x)),
        all().max_by(|a, b| by(a, b, x)),
        all().min_by(|a, b| by(a, b, y)),
        all().max_by(|a, b| by(a, b, y)),
        Some(last),
    ];
    let mut corners: Vec<usize> = outermost.into_iter().flatten().collect();
    corners.sort_unstable();
    corners.dedup();
    let mut open: Vec<(usize, usize)> = corners.windows(2).map(|c| (c[0], c[1])).collect();
    for corner in corners {
        keep[corner] = true;
    }
    while let Some((first, last)) = open.pop() {
        let furthest = (first + 1..last)
            .map(|index| (index, distance(points[index], points[first], points[last])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, distance)) = furthest
            && distance > tolerance
        {
            keep[index] = true;
            open.extend([(first, index), (index, last)]);
        }
    }
    let kept = points.iter().zip(keep);
    kept.filter_map(|(point, keep)| keep.then_some(*point))
        .collect()
}

/// Distance of a point from the line between two others.
fn distance(point: Point, from: Point, to: Point) -> f64 {
    let along = (to.0 - from.0, to.1 - from.1);
    let off = (point.0 - from.0, point.1 - from.1);
    let square = along.0 * along.0 + along.1 * along.1;
    let share = match square {
        0.0 => 0.0,
        square => ((off.0 * along.0 + off.1 * along.1) / square).clamp(0.0, 1.0),
    };
    (off.0 - share * along.0).hypot(off.1 - share * along.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_and_ends_survive() {
        let mut points: Vec<_> = (0..10_000)
            .map(|i| (f64::from(i), f64::from(i % 7)))
            .collect();
        points[4321].1 = 99.0;
        points[1234].1 = -99.0;
        let kept = decimate(&points, 100);
        assert!(kept.len() <= 600);
        assert!(kept.contains(&(4321.0, 99.0)) && kept.contains(&(1234.0, -99.0)));
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[9999]));
        assert!(kept.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn gaps_and_the_outermost_points_of_loops_survive() {
        let mut points: Vec<Point> = (0..5000)
            .map(|i| 0.01 * f64::from(i))
            .map(|t| (t.cos(), t.sin()))
            .collect();
        points[777] = (4.0, 0.0);
        points[3000] = (f64::NAN, 0.5);
        let kept = decimate(&points, 50);
        assert!(kept.contains(&(4.0, 0.0)));
        assert!(kept.iter().any(|point| point.0.is_nan()));
    }

    #[test]
    fn simplified_lines_stay_within_the_tolerance_and_keep_extremes() {
        let points: Vec<Point> = (0..=2000)
            .map(|i| 0.1 * f64::from(i))
            .map(|x| (x, 40.0 * (0.2 * x).sin()))
            .collect();
        let kept = simplify(&points, 0.1);
        assert!(kept.len() < points.len() / 5, "{}", kept.len());
        let off = |point: &Point| {
            let pairs = kept.windows(2);
            pairs
                .map(|pair| distance(*point, pair[0], pair[1]))
                .fold(f64::INFINITY, f64::min)
        };
        assert!(points.iter().map(off).fold(0.0, f64::max) <= 0.1);
        let highest = |points: &[Point]| points.iter().map(|p| p.1).fold(f64::MIN, f64::max);
        assert_eq!(highest(&kept), highest(&points));
        assert_eq!(simplify(&[], 1.0), []);
        assert_eq!(simplify(&[(1.0, 1.0); 4], 1.0).first(), Some(&(1.0, 1.0)));
    }
}
