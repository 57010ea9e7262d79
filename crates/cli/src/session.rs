use std::io::{IsTerminal, Write};
use std::sync::Arc;
use std::time::Duration;

use cpu_time::ProcessTime;
use etendue::SystemClock;
use etendue::core::{CancelFlag, Clock, Progress};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args::Threads;
use crate::error::CliError;

/// A line to standard error. If nobody can hear it, nothing can be done about that.
pub(crate) fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// A line to standard output: a result.
pub(crate) fn print(line: &str) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{line}")?;
    out.flush()
}

/// The wish to stop, from Ctrl-C or SIGTERM. The second wish ends the process at once.
#[derive(Clone, Debug)]
pub(crate) struct Interrupt(Arc<CancelFlag>);

impl Interrupt {
    pub(crate) fn listen() -> Self {
        let flag = Arc::new(CancelFlag::default());
        let heard = Arc::clone(&flag);
        let listening = ctrlc::set_handler(move || {
            if heard.cancelled() {
                std::process::exit(130);
            }
            heard.cancel();
            say("stopping; once more to stop at once, without writing");
        });
        if let Err(e) = listening {
            say(&format!("warning: Ctrl-C will end the program without writing: {e}"));
        }
        Self(flag)
    }

    pub(crate) fn requested(&self) -> bool {
        self.0.cancelled()
    }
}

/// What a render hears: a bar on a terminal, and the wish to stop.
pub(crate) struct Watch<'a> {
    interrupt: &'a Interrupt,
    bar: ProgressBar,
    /// Samples done before the call that is being watched.
    before: u64,
}

impl<'a> Watch<'a> {
    /// Counts to `total` samples.
    pub(crate) fn new(interrupt: &'a Interrupt, total: u64) -> Self {
        let target = if std::io::stderr().is_terminal() {
            ProgressDrawTarget::stderr_with_hz(5)
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some(total), target);
        if let Ok(style) =
            ProgressStyle::with_template("{wide_bar} {percent}%  {elapsed} of about {duration}")
        {
            bar.set_style(style);
        }
        Self { interrupt, bar, before: 0 }
    }

    /// The next call begins at this many samples.
    pub(crate) fn begin_at(&mut self, before: u64) {
        self.before = before;
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Watch<'_> {
    fn update(&self, done: u64, _total: u64) {
        self.bar.set_position(self.before.saturating_add(done));
    }

    fn cancelled(&self) -> bool {
        self.interrupt.requested()
    }
}

impl Progress for Interrupt {
    fn cancelled(&self) -> bool {
        self.requested()
    }
}

/// Seconds of all threads of this process.
pub(crate) struct CpuClock(ProcessTime);

impl CpuClock {
    /// `None` where the system does not tell.
    pub(crate) fn start() -> Option<Self> {
        ProcessTime::try_now().ok().map(Self)
    }
}

impl Clock for CpuClock {
    fn seconds(&self) -> f64 {
        self.0.try_elapsed().map_or(0.0, |t| t.as_secs_f64())
    }
}

/// Runs on a pool of as many threads as were asked for.
pub(crate) fn in_pool<T: Send>(
    threads: Option<Threads>,
    work: impl FnOnce() -> Result<T, CliError> + Send,
) -> Result<T, CliError> {
    match threads {
        None => work(),
        Some(n) => rayon::ThreadPoolBuilder::new()
            .num_threads(n.0)
            .build()
            .map_err(|e| CliError::Threads(n.0, e))?
            .install(work),
    }
}

/// Seconds by the wall and seconds of all threads together.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spent {
    pub(crate) wall: f64,
    pub(crate) cpu: Option<f64>,
}

impl Spent {
    /// Adds another stretch of work.
    pub(crate) fn add(&mut self, more: Self) {
        self.cpu = more.cpu.map(|c| self.cpu.unwrap_or(0.0) + c);
        self.wall += more.wall;
    }
}

/// Measures one step after the other.
pub(crate) struct Stopwatch {
    clock: SystemClock,
    at: f64,
    cpu: Option<ProcessTime>,
}

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Self { clock: SystemClock::default(), at: 0.0, cpu: ProcessTime::try_now().ok() }
    }

    /// What has been spent since the last lap.
    pub(crate) fn lap(&mut self) -> Spent {
        let (now, cpu) = (self.clock.seconds(), ProcessTime::try_now().ok());
        let seconds = |a: ProcessTime, b: ProcessTime| b.duration_since(a).as_secs_f64();
        let spent = Spent { wall: now - self.at, cpu: self.cpu.zip(cpu).map(|(a, b)| seconds(a, b)) };
        (self.at, self.cpu) = (now, cpu);
        spent
    }
}

/// The most memory that the process has held, bytes; `None` where the system does not tell.
pub(crate) fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// How often a film is saved during a long render.
pub(crate) const SAVE_EVERY: Duration = Duration::from_secs(60);
