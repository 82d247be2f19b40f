//! Section on the sea: depth, seabed, and the current over depth.

use catenix_results::{Scene, SceneCurrent};

use super::builder::{Builder, NewFigure};
use super::data::{CaseData, StudyData};
use super::format::with_unit;
use crate::figure::{Chart, ChartAxis, Curve};

/// A profile and the cases that have it.
struct Profile<'a> {
    current: &'a [SceneCurrent],
    depth_m: f64,
    cases: Vec<&'a str>,
}

pub(super) fn add(data: &StudyData<'_>, builder: &mut Builder) {
    let scenes: Vec<(&CaseData, &Scene)> = data
        .cases
        .iter()
        .filter_map(|case| Some((case, case.scene.as_ref()?)))
        .collect();
    let Some((_, first)) = scenes.first() else {
        return;
    };
    builder.section("environment", builder.text("section.environment"));
    let Some(depth) = first.water_depth_m else {
        builder.paragraph(builder.text("environment.no_water"));
        return;
    };
    let same_depth = scenes
        .iter()
        .all(|(_, scene)| scene.water_depth_m == Some(depth));
    let values = [("depth", with_unit(depth, "m"))];
    let values = values
        .each_ref()
        .map(|(name, value)| (*name, value.as_str()));
    let key = match first.seabed {
        true => "environment.water_and_seabed",
        false => "environment.water",
    };
    if same_depth {
        builder.paragraph(builder.fill(key, &values));
    }
    if scenes.iter().all(|(_, scene)| is_still(&scene.current)) {
        builder.paragraph(builder.text("environment.still"));
        return;
    }
    let speeds = distinct(&scenes, |a, b| profiles_agree(a, b, speed));
    let headings = distinct(&scenes, |a, b| profiles_agree(a, b, heading));
    profile_figure(
        builder,
        &speeds,
        "current-speed",
        "environment.speed",
        "m/s",
        speed,
    );
    let vary = |profile: &Profile<'_>| {
        let moving = profile.current.iter().filter(|point| speed(point) > 0.0);
        let mut all = moving.map(heading);
        let first = all.next();
        all.any(|other| first.is_some_and(|first| turned(first, other) > 1e-6))
    };
    if headings.iter().any(vary) {
        let name = "environment.heading";
        profile_figure(builder, &headings, "current-heading", name, "deg", heading);
    } else {
        for profile in &headings {
            let Some(moving) = profile.current.iter().find(|point| speed(point) > 0.0) else {
                continue;
            };
            let cases: Vec<String> = profile.cases.iter().map(|&name| name.to_owned()).collect();
            let cases = builder.language.list(&cases);
            let to = with_unit(heading(moving), "deg");
            let key = match headings.len() {
                1 => "environment.flows_to",
                _ => "environment.flows_to_in",
            };
            builder.paragraph(builder.fill(key, &[("heading", &to), ("cases", &cases)]));
        }
    }
    let factor = |(_, scene): &(&CaseData, &Scene)| !scene.current_factor.is_empty();
    if scenes.iter().any(factor) {
        builder.paragraph(builder.text("environment.factor"));
    }
}

/// A value of the profiles over depth, one curve for each that differs.
fn profile_figure(
    builder: &mut Builder,
    profiles: &[Profile<'_>],
    file: &str,
    title: &'static str,
    unit: &str,
    value: fn(&SceneCurrent) -> f64,
) {
    let language = builder.language;
    let curves = profiles.iter().map(|profile| {
        let mut points: Vec<(f64, f64)> = profile
            .current
            .iter()
            .map(|point| (value(point), -point.depth_m))
            .collect();
        // Constant below the last point, and above the first.
        if let (Some(top), Some(end)) = (points.first().copied(), points.last().copied()) {
            if top.1 < 0.0 {
                points.insert(0, (top.0, 0.0));
            }
            if -end.1 < profile.depth_m {
                points.push((end.0, -profile.depth_m));
            }
        }
        let cases: Vec<String> = profile.cases.iter().map(|&name| name.to_owned()).collect();
        let label = match profiles.len() {
            1 => String::new(),
            _ => builder.fill("environment.cases", &[("cases", &language.list(&cases))]),
        };
        Curve::new(&label, points)
    });
    let curves: Vec<Curve> = curves.collect();
    let mut x = ChartAxis::linear(language.text(title), unit);
    x.from_zero = unit == "m/s";
    let y = ChartAxis::linear(language.text("axis.z"), "m");
    let mut chart = Chart::new("", x, y, curves);
    chart.panels[0].height = 260.0;
    let title = builder.text(title);
    let figure = NewFigure {
        name: file,
        title: &builder.fill("environment.over_depth", &[("what", &title)]),
        caption: "",
    };
    builder.chart(&figure, chart);
}

/// Profiles that differ, with their cases.
fn distinct<'a>(
    scenes: &[(&'a CaseData, &'a Scene)],
    agree: impl Fn(&[SceneCurrent], &[SceneCurrent]) -> bool,
) -> Vec<Profile<'a>> {
    let mut profiles: Vec<Profile<'a>> = Vec::new();
    for &(case, scene) in scenes {
        let depth_m = scene.water_depth_m.unwrap_or(0.0);
        let same = profiles
            .iter_mut()
            .find(|known| known.depth_m == depth_m && agree(known.current, &scene.current));
        match same {
            Some(known) => known.cases.push(&case.name),
            None => profiles.push(Profile {
                current: &scene.current,
                depth_m,
                cases: vec![&case.name],
            }),
        }
    }
    profiles
}

/// Whether a value is the same at every depth, but for rounding.
fn profiles_agree(a: &[SceneCurrent], b: &[SceneCurrent], value: fn(&SceneCurrent) -> f64) -> bool {
    let close = |(a, b): (&SceneCurrent, &SceneCurrent)| {
        let is_same = (value(a) - value(b)).abs() <= 1e-9 * value(a).abs().max(1.0);
        a.depth_m == b.depth_m && is_same
    };
    a.len() == b.len() && a.iter().zip(b).all(close)
}

fn is_still(current: &[SceneCurrent]) -> bool {
    current.iter().all(|point| speed(point) == 0.0)
}

fn speed(point: &SceneCurrent) -> f64 {
    let [x, y] = point.velocity_m_s;
    x.hypot(y)
}

/// Direction towards which the water flows, from x towards y [deg].
fn heading(point: &SceneCurrent) -> f64 {
    let [x, y] = point.velocity_m_s;
    let degrees = y.atan2(x).to_degrees();
    // Rounding of sine and cosine would show otherwise: 180 degrees come back as 180.00000000000003.
    (degrees * 1e9).round() * 1e-9 + 0.0
}

/// Angle between two headings [deg].
fn turned(a: f64, b: f64) -> f64 {
    let difference = (a - b).rem_euclid(360.0);
    difference.min(360.0 - difference)
}
