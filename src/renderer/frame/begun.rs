//! The frame that is being recorded.

use super::positions::Moved;
use super::{Renderer, RetiredObject};
use crate::renderer::model::{Given, Sent, Used};
use crate::renderer::options::{Error, ModelId};
use rustc_hash::FxHashMap;

/// A frame that [`Renderer::begin_frame`] began, until the next one begins or it is [lost](Renderer::frame_lost): what is set and
/// recorded for it names it, and nothing else is accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    renderer: u64,
    /// How many began before, by this renderer, and one.
    number: u64,
    index: u32,
}

impl Frame {
    /// Which of [`Options::frames_in_flight`](crate::renderer::Options::frames_in_flight) it is, from 0 on: for what you keep for each
    /// of them yourself.
    pub fn index(self) -> u32 {
        self.index
    }

    /// What tells it from all others: its number, and that of its renderer.
    pub(super) fn stamp(self) -> [u64; 2] {
        [self.number, self.renderer]
    }
}

/// What the renderer knows of the frame that is being recorded.
pub(crate) struct Begun {
    frame: Frame,
    /// Whether commands may name it: not before the first frame, nor once it is lost.
    is_open: bool,
    pub(super) is_prepared: bool,
    /// What was recorded to be sent to the device, in order.
    pub(super) sent: Vec<(Option<ModelId>, Sent)>,
    /// Whose positions were set, and by whom.
    pub(super) moved: FxHashMap<ModelId, Moved>,
}

impl Begun {
    /// Whether positions of the device are to be recorded.
    pub(super) fn are_given(&self) -> bool {
        self.moved.values().any(|moved| matches!(moved, Moved::Device(Some(_))))
    }

    /// The positions of a model that the device gives, if any are to be recorded.
    pub(super) fn take_given(&mut self, id: ModelId) -> Option<Given> {
        match self.moved.get_mut(&id) {
            Some(Moved::Device(given)) => given.take(),
            _ => None,
        }
    }

    /// None yet.
    pub(super) fn new(renderer: u64, frames_in_flight: u32) -> Self {
        let frame = Frame { renderer, number: 0, index: frames_in_flight - 1 };
        Self { frame, is_open: false, is_prepared: false, sent: Vec::new(), moved: FxHashMap::default() }
    }

    /// Has what was sent of a model be nobody's, and its positions those of its mesh: it has other tables now.
    pub(super) fn forget(&mut self, id: ModelId) {
        self.moved.remove(&id);
        for (of, _) in self.sent.iter_mut().filter(|(of, _)| *of == Some(id)) {
            *of = None;
        }
    }
}

impl Renderer {
    /// Begins a frame: once for each that you record, before anything is set or recorded for it.
    ///
    /// # Safety
    /// * The device is done with the frame that began [`Options::frames_in_flight`](crate::renderer::Options::frames_in_flight)
    ///   frames ago, lost ones not counted, and with those before it: as after waiting for the fence of its submission.
    /// * Of each frame before, what [`Renderer::cmd_prepare`] recorded was submitted, in the order in which frames began, to one
    ///   queue; or the frame was [lost](Renderer::frame_lost).
    pub unsafe fn begin_frame(&mut self) -> Frame {
        let Frame { renderer, number, index } = self.begun.frame;
        let sent = std::mem::take(&mut self.begun.sent);
        let used: Vec<Used> = sent.into_iter().flat_map(|(_, sent)| sent.into_used()).collect();
        if !used.is_empty() {
            self.retire(Some(index), RetiredObject::Used(used));
        }
        // The frame in place of a lost one has its index: nothing of that is on the device.
        let is_lost = number > 0 && !self.begun.is_open;
        let index = if is_lost { index } else { (index + 1) % self.options.frames_in_flight };
        let frame = Frame { renderer, number: number + 1, index };
        self.begun = Begun { frame, is_open: true, ..Begun::new(renderer, self.options.frames_in_flight) };
        self.views_drawn[index as usize] = 0;
        self.lists[index as usize].clear();
        self.instances[index as usize].clear();
        for retired in &mut self.retired {
            retired.frames[index as usize] = false;
        }
        self.retired.retain(|retired| retired.frames.contains(&true));
        frame
    }

    /// Takes back a frame whose commands will not be submitted, such as when the swapchain is out of date: what it was to send to
    /// the device is sent by the next.
    ///
    /// # Errors
    /// [`Error::OldFrame`].
    pub fn frame_lost(&mut self, frame: Frame) -> Result<(), Error> {
        self.check_frame(frame)?;
        for (id, sent) in std::mem::take(&mut self.begun.sent).into_iter().rev() {
            let model = id.and_then(|id| self.models.get_mut(&id));
            sent.take_back(model, frame.index);
        }
        self.begun.is_open = false;
        Ok(())
    }

    /// Whether a frame is the one that is being recorded.
    pub(super) fn check_frame(&self, frame: Frame) -> Result<(), Error> {
        if self.begun.is_open && frame == self.begun.frame { Ok(()) } else { Err(Error::OldFrame) }
    }

    /// As [`Renderer::check_frame`], and whether it was prepared.
    pub(super) fn check_prepared(&self, frame: Frame) -> Result<(), Error> {
        self.check_frame(frame)?;
        if self.begun.is_prepared { Ok(()) } else { Err(Error::FrameNotPrepared) }
    }
}
