//! Thins curves that have more points than a figure has room for.

/// Keeps, in each of `buckets` stretches of the curve, the first, lowest, highest and last point.
/// What is left draws the same picture, extremes included. NaN points are kept: they are gaps.
pub(crate) fn decimate(points: &[(f64, f64)], buckets: usize) -> Vec<(f64, f64)> {
    if points.len() <= 4 * buckets {
        return points.to_vec();
    }
    let size = points.len().div_ceil(buckets);
    let mut kept = Vec::with_capacity(4 * buckets);
    for bucket in points.chunks(size) {
        let by_height = |a: &usize, b: &usize| bucket[*a].1.total_cmp(&bucket[*b].1);
        let mut indices: Vec<usize> = [
            Some(0),
            (0..bucket.len()).min_by(by_height),
            (0..bucket.len()).max_by(by_height),
            Some(bucket.len() - 1),
        ]
        .into_iter()
        .flatten()
        .collect();
        indices.sort_unstable();
        indices.dedup();
        kept.extend(indices.into_iter().map(|index| bucket[index]));
    }
    kept
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
        assert!(kept.len() <= 400);
        assert!(kept.contains(&(4321.0, 99.0)) && kept.contains(&(1234.0, -99.0)));
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[9999]));
        assert!(kept.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }
}
