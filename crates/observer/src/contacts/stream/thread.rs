//! The thread that windows are solved in.

use super::estimate::StreamError;
use super::sample::Raw;
use super::window::{Asked, Outcome, Window};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{Builder, JoinHandle};

/// Samples since the task before, and what is asked for.
struct Task {
    fresh: Vec<Raw>,
    asked: Asked,
}

/// A thread with a window: it is given one task at a time.
pub(super) struct Worker {
    tasks: Option<SyncSender<Task>>,
    done: Receiver<(Outcome, Vec<Raw>)>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    pub(super) fn new(mut window: Window) -> Result<Self, StreamError> {
        let (tasks, to_do) = sync_channel::<Task>(1);
        let (tell, done) = sync_channel(1);
        let work = move || {
            while let Ok(Task { mut fresh, asked }) = to_do.recv() {
                let outcome = window.work(&fresh, asked);
                // The memory goes back and is used again.
                fresh.clear();
                if tell.send((outcome, fresh)).is_err() {
                    break;
                }
            }
        };
        let thread =
            Builder::new().name("motion stream".to_owned()).spawn(work).map_err(|_| StreamError::Thread)?;
        Ok(Self { tasks: Some(tasks), done, thread: Some(thread) })
    }

    pub(super) fn begin(&self, fresh: Vec<Raw>, asked: Asked) -> Result<(), StreamError> {
        let tasks = self.tasks.as_ref().ok_or(StreamError::Thread)?;
        tasks.send(Task { fresh, asked }).map_err(|_| StreamError::Thread)
    }

    /// Waits for what came of the task that was begun; its memory comes back empty.
    pub(super) fn take(&self) -> Result<(Outcome, Vec<Raw>), StreamError> {
        self.done.recv().map_err(|_| StreamError::Thread)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // Without tasks the thread ends.
        self.tasks = None;
        if let Some(thread) = self.thread.take() {
            // What it did is not asked for any more, nor how it ended.
            let _ = thread.join();
        }
    }
}
