//! One experiment: pictures beside each other, each measured against a reference.

use std::error::Error;
use std::path::Path;

use etendue::SystemClock;
use etendue::io::{self, ToneMap};
use etendue::measure::compare;
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

/// A scene, where it is seen from, and what it truly looks like.
pub(crate) struct View {
    scene: Scene,
    camera: Perspective,
    clock: SystemClock,
    spp: u32,
    pub(crate) reference: Picture,
    /// What the reference itself is expected to add to the relMSE, by pixel; NaN where nothing tells.
    own_error: Vec<f64>,
}

impl View {
    pub(crate) fn new(p: Preset, size: UVec2, way: PathTracer, spp: u32) -> Outcome<Self> {
        let camera = Perspective::look_at(p.eye, p.target, Vec3A::Y, p.vertical_fov_deg, size)?;
        let scene = p.builder.build()?;
        let mut film = Film::new(size, REPLICATES)?;
        let sampler = Sobol::new(REFERENCE_SEED, spp).with_replicates(REPLICATES);
        render(&scene, &camera, &way, sampler, &mut film, &RenderOptions::default())?;
        let own_error = (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y))).map(|p| {
            let errors = film.standard_error(p).unwrap_or([f64::NAN; 3]);
            let means = film.mean(p).to_array().map(f64::from);
            errors.iter().zip(means).map(|(e, r)| e * e / (r * r + 0.01)).sum::<f64>() / 3.0
        });
        let (own_error, reference) = (own_error.collect(), film.to_rgb());
        Ok(Self { scene, camera, clock: SystemClock::default(), spp, reference, own_error })
    }

    /// The part of a picture between two corners, in fractions of its sides; never empty.
    fn crop<T: Copy>(&self, pixels: &[T], [x0, y0, x1, y1]: [f32; 4]) -> Vec<T> {
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
}

/// One line of the table.
struct Measured {
    name: &'static str,
    spp: u32,
    seconds: f64,
    /// Mean of the picture over that of the reference.
    brightness: f64,
    /// relMSE of the regions.
    errors: Vec<f64>,
}

/// One experiment: panels beside each other, and a table.
pub(crate) struct Study<'a> {
    view: &'a View,
    /// What the textbook says one should see.
    says: &'static str,
    /// Panels in a row.
    pub(crate) across: usize,
    /// Parts of the picture with a column of their own, beside the whole.
    pub(crate) regions: Vec<(&'static str, [f32; 4])>,
    shown: Vec<Picture>,
    table: Vec<Measured>,
}

impl<'a> Study<'a> {
    pub(crate) fn new(view: &'a View, says: &'static str) -> Self {
        Self { view, says, across: usize::MAX, regions: Vec::new(), shown: Vec::new(), table: Vec::new() }
    }

    fn all_regions(&self) -> Vec<(&'static str, [f32; 4])> {
        [("whole", [0.0, 0.0, 1.0, 1.0])].into_iter().chain(self.regions.iter().copied()).collect()
    }

    /// Renders with several seeds, adds a line to the table, and returns the first picture.
    pub(crate) fn measure<S: Sampler>(
        &mut self,
        name: &'static str,
        way: PathTracer,
        sampler: impl Fn(u64) -> S,
    ) -> Outcome<Picture> {
        let (view, regions) = (self.view, self.all_regions());
        let options = RenderOptions { clock: Some(&view.clock), ..RenderOptions::default() };
        let spp = sampler(0).spp();
        let errors = vec![0.0; regions.len()];
        let mut line = Measured { name, spp, seconds: f64::INFINITY, brightness: 0.0, errors };
        let mut first = None;
        for seed in 1..=SEEDS {
            let mut film = Film::new(view.camera.resolution(), 1)?;
            let report = render(&view.scene, &view.camera, &way, sampler(seed), &mut film, &options)?;
            let picture = film.to_rgb();
            // The least: other programs only add.
            line.seconds = line.seconds.min(report.seconds.unwrap_or(f64::NAN));
            for (i, (error, (_, region))) in line.errors.iter_mut().zip(&regions).enumerate() {
                let c = compare(&view.crop(&picture, *region), &view.crop(&view.reference, *region))?;
                *error += c.relative_mse / SEEDS as f64;
                if i == 0 {
                    line.brightness +=
                        c.mean.iter().sum::<f64>() / c.reference_mean.iter().sum::<f64>() / SEEDS as f64;
                }
            }
            first.get_or_insert(picture);
        }
        self.table.push(line);
        first.ok_or_else(|| "no seed".into())
    }

    /// As [`Study::measure`], and shows the picture.
    pub(crate) fn panel<S: Sampler>(
        &mut self,
        name: &'static str,
        way: PathTracer,
        sampler: impl Fn(u64) -> S,
    ) -> Outcome<()> {
        let picture = self.measure(name, way, sampler)?;
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
        regions.iter().for_each(|(name, _)| print!("{:>27}", format!("relMSE {name}")));
        let own = regions.iter().map(|(_, region)| {
            let errors = view.crop(&view.own_error, *region);
            errors.iter().sum::<f64>() / errors.len() as f64
        });
        let own: Vec<f64> = own.collect();
        for m in &self.table {
            print!("\n  {:<16}{:>5}{:>10.4}{:>12.4}", m.name, m.spp, m.seconds, m.brightness);
            for (e, own) in m.errors.iter().zip(&own) {
                // `!` is for NaN.
                let limited = if !(*e > 10.0 * own) { "~" } else { "" };
                print!("{:>27}", format!("{limited}{e:.3e}"));
            }
        }
        print!("\n  {:<16}{:>5}{:>10}{:>12}", "reference", view.spp, "", "");
        own.iter().for_each(|own| print!("{own:>27.3e}"));
        println!(
            "\n  The reference's own error is in every number; ~ marks those of which it may be a tenth or more."
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
