use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use etendue::SystemClock;
use etendue::camera::{Camera, Film};
use etendue::core::Clock;
use etendue::integrator::{Ended, RenderOptions, render};
use etendue::io::{FilmFile, FilmInfo, write_film};
use etendue::measure::Reference;
use etendue::sampling::Sampler;
use etendue::scene::Scene;

use super::curve::{CurveLog, at_powers_of_two};
use super::settings::Settings;
use crate::args::Ready;
use crate::error::CliError;
use crate::outputs::{Kind, Output};
use crate::report::{Totals, needs};
use crate::session::{Interrupt, SAVE_EVERY, Spent, Stopwatch, Watch, say};

/// Name of a film that is not in a file yet, in messages.
const HERE: &str = "this render";
/// Most samples per pixel that an interrupt can take from a film file.
const LONGEST: u64 = 16;

/// A scene to be rendered.
pub(super) struct Work<'a> {
    pub(super) scene: &'a Scene,
    pub(super) camera: &'a dyn Camera,
    pub(super) settings: &'a Settings,
    pub(super) integrator: &'a Ready,
    pub(super) words: BTreeMap<String, String>,
    pub(super) outputs: &'a [Output],
    pub(super) interrupt: &'a Interrupt,
    /// Where a curve goes, and what it measures against.
    pub(super) curve: Option<(&'a Path, &'a Reference)>,
}

/// What came out.
pub(crate) struct Outcome {
    /// With the sample indices that every pixel has.
    pub(crate) info: FilmInfo,
    films: Films,
    pub(crate) totals: Totals,
}

/// The sums.
enum Films {
    /// No film file was asked for: some pixels may have more samples than others.
    One(Film),
    /// A film of whole passes, and the same with the samples of a pass that was not finished.
    Whole(Box<FilmFile>, Option<Film>),
}

impl Outcome {
    /// All samples drawn, also those of a pass that was not finished.
    pub(crate) fn picture(&self) -> &Film {
        match &self.films {
            Films::One(film) | Films::Whole(_, Some(film)) => film,
            Films::Whole(whole, None) => whole.film(),
        }
    }

    /// The film of whole passes, if a film file was asked for.
    pub(crate) fn whole(&self) -> Option<&FilmFile> {
        match &self.films {
            Films::One(_) => None,
            Films::Whole(whole, _) => Some(whole),
        }
    }
}

impl Work<'_> {
    fn empty<S: Sampler>(&self, sampler: &S) -> Result<Film, CliError> {
        Ok(Film::with_planes(self.camera.resolution(), sampler.replicates(), self.settings.planes)?)
    }

    /// Draws the samples that are asked for and not there yet. `info` has no samples.
    pub(super) fn run<S: Sampler>(
        &self,
        sampler: S,
        info: FilmInfo,
        resumed: Option<FilmFile>,
    ) -> Result<Outcome, CliError> {
        let empty = FilmFile::new(HERE, info, self.empty(&sampler)?)?;
        let start = match resumed {
            None => empty,
            Some(film) => {
                film.check(&empty)?;
                drop(empty);
                film
            }
        };
        let missing = start.info().samples.missing(self.settings.indices.clone());
        let pixels = u64::from(self.camera.resolution().x) * u64::from(self.camera.resolution().y);
        let samples: u64 = missing.iter().map(|r| r.end - r.start).sum();
        let mut watch = Watch::new(self.interrupt, samples.saturating_mul(pixels));
        let mut totals =
            Totals { needs: needs(self.scene.needs() | self.camera.needs()), ..Totals::default() };
        let mut run = Run {
            work: self,
            sampler,
            clock: SystemClock::default(),
            spent: Spent::default(),
            curve: self.curve.map(|(_, reference)| CurveLog::new(reference)),
            totals: &mut totals,
        };
        let outcome = if self.outputs.iter().any(|o| o.kind == Kind::Film) {
            run.in_whole_passes(start, missing, &mut watch)
        } else {
            run.at_once(start, missing, &mut watch)
        };
        let written = self.curve.zip(run.curve).map(|((path, _), log)| log.write(path)).transpose();
        watch.finish();
        let (info, films) = outcome?;
        written?;
        Ok(Outcome { info, films, totals })
    }

    /// Saves what there is, so that a crash of the machine costs a minute and not the night.
    fn save(&self, whole: &FilmFile) {
        for output in self.outputs.iter().filter(|o| o.kind == Kind::Film) {
            if let Err(e) = write_film(&output.path, whole) {
                say(&format!("warning: {e}; the render goes on"));
            }
        }
    }
}

struct Run<'a, S> {
    work: &'a Work<'a>,
    sampler: S,
    clock: SystemClock,
    /// Of drawing alone.
    spent: Spent,
    curve: Option<CurveLog<'a>>,
    totals: &'a mut Totals,
}

impl<S: Sampler> Run<'_, S> {
    /// Seconds that are left; `None` without a budget.
    fn left(&self) -> Option<f64> {
        self.work.settings.time.map(|t| (t - self.spent.wall).max(0.0))
    }

    /// Draws one range into a film; gives the indices that every pixel has got.
    fn draw(
        &mut self,
        film: &mut Film,
        range: Range<u64>,
        watch: &mut Watch<'_>,
    ) -> Result<Range<u64>, CliError> {
        watch.begin_at(self.totals.samples);
        let w = self.work;
        let options = RenderOptions {
            samples: Some(range),
            filter: w.settings.filter,
            progress: &*watch,
            seconds: self.left(),
            clock: Some(&self.clock),
            ..RenderOptions::default()
        };
        let mut stopwatch = Stopwatch::start();
        let report = render(w.scene, w.camera, w.integrator.integrator(), self.sampler, film, &options)?;
        self.spent.add(stopwatch.lap());
        self.totals.add(&report);
        Ok(report.complete)
    }

    /// The ranges, cut where a curve has its points.
    fn pieces(&self, ranges: Vec<Range<u64>>) -> Vec<Range<u64>> {
        match self.curve {
            None => ranges,
            Some(_) => ranges.into_iter().flat_map(at_powers_of_two).collect(),
        }
    }

    /// Without a film file, one film takes everything.
    fn at_once(
        &mut self,
        start: FilmFile,
        missing: Vec<Range<u64>>,
        watch: &mut Watch<'_>,
    ) -> Result<(FilmInfo, Films), CliError> {
        let (mut info, mut film) = start.into_parts();
        for range in self.pieces(missing) {
            let complete = self.draw(&mut film, range, watch)?;
            info.samples.insert(complete);
            if self.totals.ended != Ended::Complete {
                break;
            }
            self.look(&film, &info, false)?;
        }
        self.look(&film, &info, true)?;
        Ok((info, Films::One(film)))
    }

    /// For a film file, each range goes into a film of its own, and is added when every pixel has it.
    fn in_whole_passes(
        &mut self,
        start: FilmFile,
        missing: Vec<Range<u64>>,
        watch: &mut Watch<'_>,
    ) -> Result<(FilmInfo, Films), CliError> {
        let mut whole = start;
        let mut saved = self.clock.seconds();
        let mut step = 1;
        let mut ranges = self.pieces(missing).into_iter();
        let mut rest = ranges.next().unwrap_or(0..0);
        while !rest.is_empty() {
            let range = rest.start..rest.end.min(rest.start.saturating_add(step));
            step = (step * 2).min(LONGEST);
            let mut film = self.work.empty(&self.sampler)?;
            let complete = self.draw(&mut film, range.clone(), watch)?;
            if self.totals.ended == Ended::Cancelled {
                // Some pixels have more than others: for the picture only.
                film.merge(whole.film()).map_err(|e| CliError::Usage(e.to_string()))?;
                return Ok((whole.info().clone(), Films::Whole(Box::new(whole), Some(film))));
            }
            let mut info = whole.info().clone();
            info.samples = complete.into();
            whole = whole.merge(&FilmFile::new(HERE, info, film)?)?;
            if self.totals.ended == Ended::Time {
                break;
            }
            self.look(whole.film(), whole.info(), false)?;
            if self.clock.seconds() - saved > SAVE_EVERY.as_secs_f64() {
                self.work.save(&whole);
                saved = self.clock.seconds();
            }
            rest = if range.end < rest.end { range.end..rest.end } else { ranges.next().unwrap_or(0..0) };
        }
        self.look(whole.film(), whole.info(), true)?;
        Ok((whole.info().clone(), Films::Whole(Box::new(whole), None)))
    }

    fn look(&mut self, film: &Film, info: &FilmInfo, at_end: bool) -> Result<(), CliError> {
        // A film of an unfinished pass has no one number of samples.
        let whole = self.totals.ended != Ended::Cancelled;
        match &mut self.curve {
            Some(log) if whole => log.look(film, info.samples.count(), self.totals, self.spent, at_end),
            _ => Ok(()),
        }
    }
}
