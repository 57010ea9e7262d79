//! One experiment: pictures beside each other, each measured against a reference.

use std::error::Error;
use std::path::Path;

use etendue::SystemClock;
use etendue::io::{self, ToneMap};
use etendue::measure::{
    self, Budget, Clocks, Contender, Estimator, Metric, Point, Reference, RenderRun, Residual, race,
};
use etendue::prelude::*;
use etendue::scene::presets::Preset;

pub(crate) type Outcome<T> = Result<T, Box<dyn Error>>;

/// Pictures over whose seeds a panel's error is averaged: the error of one picture is a random number itself.
const SEEDS: u64 = 8;
/// The reference's seed, which no panel has.
const REFERENCE_SEED: u64 = 1000;
/// Independent parts of the reference; their scatter tells its own error.
const REPLICATES: u32 = 8;
/// Pixels between panels.
const GAP: usize = 2;
const GREY: [u8; 3] = [128; 3];

/// Linear pixels, row by row.
type Picture = Vec<[f32; 3]>;

/// A part of a picture, between two corners in fractions of its sides.
pub(crate) type Region = [f32; 4];
const WHOLE: Region = [0.0, 0.0, 1.0, 1.0];

/// A scene, where it is seen from, and what it truly looks like.
pub(crate) struct View {
    scene: Scene,
    camera: Perspective,
    clock: SystemClock,
    spp: u32,
    pub(crate) reference: Picture,
    /// What the reference itself is expected to add to the relMSE, by pixel.
    own_error: Vec<f64>,
}

impl View {
    pub(crate) fn new(p: Preset, size: UVec2, way: PathTracer, spp: u32) -> Outcome<Self> {
        let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, size)?;
        let scene = p.builder.build()?;
        // Every part needs a sample to tell anything.
        let spp = spp.max(REPLICATES);
        let mut film = Film::new(size, REPLICATES)?;
        let sampler = Sobol::new(REFERENCE_SEED, spp).with_replicates(REPLICATES);
        render(&scene, &camera, &way, sampler, &mut film, &RenderOptions::default())?;
        let own_error = (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y))).map(|p| {
            let errors = film.standard_error(p).unwrap_or_default();
            let means = film.mean(p).to_array().map(f64::from);
            errors.iter().zip(means).map(|(e, r)| e * e / (r * r + 0.01)).sum::<f64>() / 3.0
        });
        let (own_error, reference) = (own_error.collect(), film.to_rgb());
        Ok(Self { scene, camera, clock: SystemClock::default(), spp, reference, own_error })
    }

    /// A part of a picture; never empty.
    fn crop<T: Copy>(&self, pixels: &[T], [x0, y0, x1, y1]: Region) -> Vec<T> {
        let size = self.camera.resolution();
        let ends = |lo: f32, hi: f32, n: u32| {
            let first = ((lo * n as f32) as u32).min(n - 1);
            first..((hi * n as f32).ceil() as u32).clamp(first + 1, n)
        };
        let columns = ends(x0, x1, size.x);
        ends(y0, y1, size.y)
            .flat_map(|y| columns.clone().map(move |x| pixels[(y * size.x + x) as usize]))
            .collect()
    }

    /// A part of the reference, with its own error.
    fn reference(&self, region: Region) -> Reference {
        let rgb = self.crop(&self.reference, region);
        let errors = self.crop(&self.own_error, region);
        let relative = errors.iter().sum::<f64>() / errors.len() as f64;
        // Only relMSE is asked for.
        let residual = Residual { relative, ..Residual::default() };
        Reference { size: [rgb.len() as u32, 1], rgb, residual }
    }
}

/// One line of the table.
struct Line {
    name: &'static str,
    spp: u32,
    seconds: f64,
    /// Mean of the pictures over that of the reference.
    brightness: f64,
    /// relMSE of the regions.
    errors: Vec<measure::Measured>,
    /// Whether much of it may be the reference's.
    limited: Vec<bool>,
}

/// One experiment: panels beside each other, and a table.
pub(crate) struct Study<'a> {
    view: &'a View,
    /// What the textbook says one should see.
    says: &'static str,
    /// Panels in a row.
    pub(crate) across: usize,
    /// Parts of the picture with a column of their own, beside the whole.
    pub(crate) regions: Vec<(&'static str, Region)>,
    shown: Vec<Picture>,
    table: Vec<Line>,
}

impl<'a> Study<'a> {
    pub(crate) fn new(view: &'a View, says: &'static str) -> Self {
        Self { view, says, across: usize::MAX, regions: Vec::new(), shown: Vec::new(), table: Vec::new() }
    }

    fn all_regions(&self) -> Vec<(&'static str, Region)> {
        [("whole", WHOLE)].into_iter().chain(self.regions.iter().copied()).collect()
    }

    /// Renders with several seeds, adds a line to the table, and returns the first picture.
    pub(crate) fn measure<S: Sampler>(
        &mut self,
        name: &'static str,
        way: PathTracer,
        spp: u32,
        sampler: impl Fn(u64, u32) -> S + Copy,
    ) -> Outcome<Picture> {
        let view = self.view;
        let run = |seed| -> Outcome<Box<dyn Estimator + '_>> {
            let run = RenderRun::new(&view.scene, &view.camera, &way, move |spp| sampler(seed, spp))?;
            // A number of samples is what some samplers divide.
            Ok(Box::new(run.anew()))
        };
        let runs = (1..=SEEDS).map(run).collect::<Outcome<Vec<_>>>()?;
        let mut field = [Contender { name: name.into(), runs }];
        let clocks = Clocks { wall: &view.clock, cpu: None };
        let budget = Budget { spp: spp.into(), seconds: None };
        let whole = view.reference(WHOLE);
        let curves = race(&mut field, Some(&whole), &budget, clocks, &())?;
        let last = curves[0].points.last().ok_or("no samples")?;
        let pictures: Vec<Picture> = field[0].runs.iter().map(|r| r.picture()).collect();

        let mut line = Line {
            name,
            spp,
            // The least: other programs only add.
            seconds: last.costs.iter().map(|c| c.seconds).fold(f64::INFINITY, f64::min),
            brightness: mean(pictures.iter().flatten()) / mean(&view.reference),
            errors: Vec::new(),
            limited: Vec::new(),
        };
        for (_, region) in self.all_regions() {
            let parts: Vec<Picture> = pictures.iter().map(|p| view.crop(p, region)).collect();
            let reference = view.reference(region);
            let point = Point::new(spp.into(), last.costs.clone(), &parts, Some(&reference))?;
            let error = point.error(Metric::Relative).ok_or("no pictures")?;
            line.limited.push(error.value < 10.0 * reference.residual.relative);
            line.errors.push(error);
        }
        self.table.push(line);
        pictures.into_iter().next().ok_or_else(|| "no seed".into())
    }

    /// As [`Study::measure`], and shows the picture.
    pub(crate) fn panel<S: Sampler>(
        &mut self,
        name: &'static str,
        way: PathTracer,
        spp: u32,
        sampler: impl Fn(u64, u32) -> S + Copy,
    ) -> Outcome<()> {
        let picture = self.measure(name, way, spp, sampler)?;
        self.show(&picture);
        Ok(())
    }

    pub(crate) fn show(&mut self, picture: &Picture) {
        self.shown.push(picture.clone());
    }

    /// Prints the table, and writes the panels if there is a place for them.
    pub(crate) fn report(&self, to: Option<&Path>) -> Outcome<()> {
        self.print();
        if let Some(to) = to {
            self.write(to)?;
            println!("  wrote {}", to.display());
        }
        Ok(())
    }

    fn print(&self) {
        let view = self.view;
        println!("\n{}", self.says);
        print!("  {:<16}{:>5}{:>10}{:>12}", "panel", "spp", "seconds", "brightness");
        let regions = self.all_regions();
        regions.iter().for_each(|(name, _)| print!("{:>28}", format!("relMSE {name}")));
        for m in &self.table {
            print!("\n  {:<16}{:>5}{:>10.4}{:>12.4}", m.name, m.spp, m.seconds, m.brightness);
            for (e, limited) in m.errors.iter().zip(&m.limited) {
                let mark = if *limited { "~" } else { "" };
                let half = e.relative_half_width().map_or(String::new(), |h| format!(" ±{:.1} %", 100.0 * h));
                print!("{:>28}", format!("{mark}{:.3e}{half}", e.value));
            }
        }
        print!("\n  {:<16}{:>5}{:>10}{:>12}", "reference", view.spp, "", "");
        for (_, region) in regions {
            print!("{:>28.3e}", view.reference(region).residual.relative);
        }
        println!(
            "\n  The reference's own error is in every number; ~ marks those of which it may be a tenth or more. ± holds 95 %."
        );
    }

    fn write(&self, to: &Path) -> Outcome<()> {
        let size = self.view.camera.resolution();
        let (w, h) = (size.x as usize, size.y as usize);
        let across = self.across.min(self.shown.len());
        let down = self.shown.len().div_ceil(across);
        let (width, height) = (across * (w + GAP) - GAP, down * (h + GAP) - GAP);
        let mut pixels = vec![GREY; width * height];
        for (i, picture) in self.shown.iter().enumerate() {
            let (left, top) = (i % across * (w + GAP), i / across * (h + GAP));
            for (y, row) in picture.chunks(w).enumerate() {
                let start = (top + y) * width + left;
                for (to, from) in pixels[start..start + w].iter_mut().zip(row) {
                    *to = ToneMap::default().bytes(Spectrum::from(*from));
                }
            }
        }
        io::write_png_pixels(to, [width as u32, height as u32], &pixels)?;
        Ok(())
    }
}

fn mean<'a>(pixels: impl IntoIterator<Item = &'a [f32; 3]>) -> f64 {
    let (sum, n) = pixels
        .into_iter()
        .fold((0.0, 0.0), |(sum, n), p| (sum + p.iter().map(|c| f64::from(*c)).sum::<f64>(), n + 3.0));
    sum / n
}
