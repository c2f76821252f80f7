"""A session that goes on with a robot whose file has changed: angles, balls and settings stay by their names."""

from __future__ import annotations

from ...model.limits import Limits
from ...robot import Robot
from ..protocol.setup import apply_what_fits, read_setup, write_setup
from ..simulation.another_robot import with_robot
from ..simulation.session import Session

__all__ = ["reloaded"]


def reloaded(session: Session, robot: Robot) -> Session:
    """The session with the robot as it is in its file now.

    Joints keep their angles, inside their new limits, and balls their frames and positions, from where they move on.
    What the robot no longer has is dropped, which the session's notes say.
    """
    other = with_robot(session, robot)
    setup = read_setup(write_setup(session))
    for part in ("angles", "lead"):  # whose joints may be gone; the poses are taken over below
        setup.pop(part, None)
    other.notes = [*other.notes, *apply_what_fits(other, setup)]
    other.motion.go_on_from(session.motion)
    places = {ball.frame: ball.position for ball in session.balls}
    for ball in other.balls:
        ball.put(places.get(ball.frame, ball.position))
    for old, new in zip(session.instances, other.instances, strict=True):
        q = new.q.copy()
        kept = session.robot.angles(old.q)
        for name in robot.joint_names:
            if name in kept:
                robot.joint(name).set_angle(q, kept[name])
        for joint in robot.joints:
            if not joint.has_one_axis and joint.name in (places := session.robot.joint_placements(old.q)):
                joint.set_placement(q, places[joint.name])
        new.put(Limits.of(robot).wrap(q) if session.settings.limits else q)
    if led := session.leading.among(session.balls.targets):
        leader = other.instances[min(led)]
        for ball in other.balls:
            if ball.mode != "off":
                ball.follow(robot.placement(ball.frame, leader.q))
        other.leading.hold(led, other.balls.targets)
    return other
