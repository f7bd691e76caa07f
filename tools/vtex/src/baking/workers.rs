//! Bakes in separate processes with limits on time and memory, so that a drawing that hangs, aborts
//! or exhausts memory makes one file fail and nothing else.
//!
//! The two limits are enforced from two sides. A worker limits its own memory before the first bake
//! (`memory.rs`); the system then refuses an allocation past the limit and Rust aborts the process.
//! The parent limits the time: a thread beside each conversation kills the worker when its answer
//! is late.

use std::ffi::OsString;
use std::io::{self, BufReader, Read};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use super::wire::{self, Reply, Request, Summary};
use crate::cli::args::Budget;
use crate::cli::{ExitCode, Failure, Outcome};

/// Most bytes of a dead worker's standard error that are read to find out why it died.
const MAX_LAST_WORDS: u64 = 4096;

/// A bake that a worker made.
#[derive(Debug)]
pub(crate) struct WorkersBake {
    /// The bytes of the file.
    pub(crate) bytes: Vec<u8>,
    /// What the bake made, in numbers, and its warnings.
    pub(crate) summary: Summary,
}

/// Processes that each bake one drawing after another. A process that dies is replaced.
#[derive(Debug)]
pub(crate) struct Workers {
    /// Arguments with which this program runs as a worker.
    arguments: Vec<OsString>,
    budget: Budget,
    idle: Mutex<Vec<Worker>>,
}

impl Workers {
    /// Workers with `threads` threads each; none is started yet. A worker gets the command line of
    /// this process and takes the options of the bake from it.
    pub(crate) fn new(budget: Budget, threads: usize) -> Self {
        let head = ["--threads", &threads.to_string(), "worker", "--"].map(OsString::from);
        Self {
            arguments: head
                .into_iter()
                .chain(std::env::args_os().skip(1))
                .collect(),
            budget,
            idle: Mutex::default(),
        }
    }

    /// Bakes the SVG read from `path`; callable from several threads at once.
    ///
    /// # Errors
    /// When the bake fails, exceeds its time or memory, or its process dies of something else.
    pub(crate) fn bake(
        &self,
        path: &Path,
        svg: &[u8],
        detail: &(dyn Fn(&str) + Sync),
    ) -> Outcome<WorkersBake> {
        let idle = self.locked().pop();
        if let Some(worker) = idle {
            match self.ask(worker, path, svg, detail) {
                // Earlier drawings may have left this process little free memory. Before the
                // drawing is blamed it gets a fresh process with the whole budget.
                Err(Death::Memory | Death::Other(_)) => {}
                other => return other.unwrap_or_else(|death| Err(self.failure(path, &death))),
            }
        }
        let worker = Worker::start(&self.arguments)?;
        self.ask(worker, path, svg, detail)
            .unwrap_or_else(|death| Err(self.failure(path, &death)))
    }

    /// Sends one drawing to a worker, and keeps the worker for the next if it survives.
    fn ask(
        &self,
        mut worker: Worker,
        path: &Path,
        svg: &[u8],
        detail: &(dyn Fn(&str) + Sync),
    ) -> Result<Outcome<WorkersBake>, Death> {
        let time = Duration::from_secs(u64::from(self.budget.timeout));
        let answer = worker.bake(path, svg, time, detail)?;
        self.locked().push(worker);
        Ok(answer)
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, Vec<Worker>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn failure(&self, path: &Path, death: &Death) -> Failure {
        let Budget {
            timeout,
            max_memory,
        } = self.budget;
        let (code, text) = match death {
            Death::Time => (
                ExitCode::Limit,
                format!(
                    "limit exceeded: not baked within {timeout} s; --timeout SECONDS allows more"
                ),
            ),
            Death::Memory => (
                ExitCode::Limit,
                format!(
                    "limit exceeded: needs more than {max_memory} MiB; --max-memory MIB allows more"
                ),
            ),
            Death::Stack => (
                ExitCode::Limit,
                "limit exceeded: nested too deeply".to_owned(),
            ),
            Death::Other(how) => (
                ExitCode::Runtime,
                format!("the process that baked it ended early: {how}"),
            ),
        };
        Failure::new(code, format!("{}: {text}", path.display()))
    }
}

/// Why a worker died.
#[derive(Debug)]
enum Death {
    /// We killed it because its time was over.
    Time,
    /// The system refused it memory.
    Memory,
    /// A thread ran out of stack.
    Stack,
    /// Something else, in words.
    Other(String),
}

#[derive(Debug)]
struct Worker {
    child: Child,
    requests: ChildStdin,
    replies: BufReader<ChildStdout>,
}

impl Worker {
    fn start(arguments: &[OsString]) -> Outcome<Self> {
        let cannot = |why: &str| Failure::runtime(format!("cannot start a process to bake: {why}"));
        let program = std::env::current_exe().map_err(|error| cannot(&error.to_string()))?;
        let mut child = Command::new(program)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| cannot(&error.to_string()))?;
        match (child.stdin.take(), child.stdout.take()) {
            (Some(requests), Some(replies)) => Ok(Self {
                child,
                requests,
                replies: BufReader::new(replies),
            }),
            _ => Err(cannot("it has no pipes")),
        }
    }

    /// Sends one drawing and waits for the answer. Kills the worker if there is none after `time`.
    fn bake(
        &mut self,
        path: &Path,
        svg: &[u8],
        time: Duration,
        detail: &(dyn Fn(&str) + Sync),
    ) -> Result<Outcome<WorkersBake>, Death> {
        let late = AtomicBool::new(false);
        let (child, requests, replies) = (&mut self.child, &mut self.requests, &mut self.replies);
        let answer = thread::scope(|scope| {
            let (answered, watched) = mpsc::channel::<()>();
            let late = &late;
            scope.spawn(move || {
                if watched.recv_timeout(time) == Err(RecvTimeoutError::Timeout) {
                    late.store(true, Ordering::Relaxed);
                    // This fails only when the worker has already ended.
                    let _ = child.kill();
                }
            });
            let answer = converse(requests, replies, path, svg, detail);
            drop(answered);
            answer
        });
        // Relaxed is enough: the end of the scope joins the thread that stores.
        if late.load(Ordering::Relaxed) {
            return Err(Death::Time);
        }
        answer.map_err(|error| self.autopsy(&error))
    }

    /// Why the worker stopped answering.
    fn autopsy(&mut self, error: &io::Error) -> Death {
        // A dying process closes its pipes a moment before its exit status can be read.
        let status = self.wait_or_kill();
        let mut words = Vec::new();
        if let Some(stderr) = self.child.stderr.take() {
            // Without text the exit status alone has to tell.
            let _ = stderr.take(MAX_LAST_WORDS).read_to_end(&mut words);
        }
        let words = String::from_utf8_lossy(&words);
        // The worker exits with `Limit` itself when the SVG does not fit into its memory. Later
        // allocations that fail abort the process, and so does a stack overflow; the text that
        // Rust's runtime prints is the only sign of which it was.
        let no_room = status.and_then(|s| s.code()) == Some(ExitCode::Limit as i32);
        if no_room || words.contains("memory allocation of") {
            Death::Memory
        } else if words.contains("has overflowed its stack") {
            Death::Stack
        } else {
            let status = status.map_or_else(|| error.to_string(), |status| status.to_string());
            Death::Other(format!("{status} {}", words.trim()))
        }
    }

    fn wait_or_kill(&mut self) -> Option<ExitStatus> {
        for _ in 0..200 {
            if let Ok(Some(status)) = self.child.try_wait() {
                return Some(status);
            }
            thread::sleep(Duration::from_millis(5));
        }
        let _ = self.child.kill();
        self.child.wait().ok()
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // A worker has nothing to clean up. Waiting for it leaves no zombie behind.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn converse(
    requests: &mut ChildStdin,
    replies: &mut BufReader<ChildStdout>,
    path: &Path,
    svg: &[u8],
    detail: &(dyn Fn(&str) + Sync),
) -> io::Result<Outcome<WorkersBake>> {
    let request = Request {
        path: path.into(),
        svg_bytes: svg.len() as u64,
    };
    wire::send(requests, &request, svg)?;
    loop {
        match wire::receive(replies)? {
            Reply::Detail(text) => detail(&text),
            Reply::Failed(failure) => return Ok(Err(failure)),
            Reply::Baked { bytes, summary } => {
                let bytes = wire::receive_bytes(replies, bytes)?;
                return Ok(Ok(WorkersBake { bytes, summary }));
            }
        }
    }
}
