/** Where the balls are in the picture, and the rings around one of them. */

const RINGS = 5; // radius of the rings around a ball, in radii of the ball
const LEAST = 46; // [px] radius of the rings on the screen

/** The radius of the rings around a ball [m]. */
export function ringRadius({ cast, stage }) {
    return Math.max(RINGS * cast.ballRadius, LEAST * stage.pixel);
}

/** Every visible copy of every ball: {k, instance, at, radius, room}, in pixels of the canvas; `room` with its rings. */
export function ballsOnScreen(show) {
    if (!show.state || !show.robot) return [];
    const radius = show.cast.ballRadius / show.stage.pixel;
    const copies = show.overlaid ? 1 : show.cast.instances.length; // robots in one place share one
    return Array.from({ length: Math.min(copies, show.cast.instances.length) }, (_, instance) => instance).flatMap(
        (instance) =>
            show.balls.places.flatMap((_place, k) => {
                const ball = show.state.balls[k];
                if (!ball || ball.mode === "off") return [];
                const room = ball.oriented && k === show.selected ? ringRadius(show) / show.stage.pixel : radius;
                return [{ k, instance, radius, room, at: show.stage.project(show.ballInWorld(k, instance)) }];
            }),
    );
}
