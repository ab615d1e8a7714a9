//! A finger whose tip is a point, on a body that nobody holds.

use glam::DVec3;

use super::followed::Followed;
use super::point::Point;
use super::touch::Touch;
use crate::contact::cones::Cone;
use crate::servo::settings::Moment;

impl Point {
    /// What the force of a finger stays in on a body that it may move: the cone of its friction. Without
    /// friction it holds nothing that slides away under it.
    pub(super) fn cone(&self, followed: &Followed<'_>, push: DVec3) -> Option<Cone> {
        let Moment {
            body,
            settings,
            frame,
            ..
        } = followed.moment;
        let proxy = self.proxy.as_ref().filter(|_| !frame.is_held())?;
        let feel = &settings.feel;
        let width = if proxy.is_sticking() {
            feel.static_friction
        } else {
            feel.dynamic_friction
        };
        let push = push.normalize_or_zero();
        Some(if width > 0.0 {
            Cone::of(-proxy.normal(body, feel, -push), width)
        } else {
            Cone::of(push, 0.0)
        })
    }

    /// The contact of a finger that does not act on a body which it would move. One that acts was to be
    /// answered.
    pub(super) fn feel_nothing(&mut self, followed: &Followed<'_>, acts: bool) -> Touch {
        self.begin = followed.shot.probe;
        if acts {
            Touch::nan(followed)
        } else {
            Touch::none(followed)
        }
    }
}
