/** Where the balls are in the picture. */

/** Every visible copy of every ball: {k, instance, at, radius}, in pixels of the canvas. */
export function ballsOnScreen(show) {
    if (!show.state || !show.robot) return [];
    const radius = show.cast.ballRadius / show.stage.pixel;
    const copies = show.overlaid ? 1 : show.cast.instances.length; // robots in one place share one
    return Array.from({ length: Math.min(copies, show.cast.instances.length) }, (_, instance) => instance).flatMap(
        (instance) =>
            show.balls.places.flatMap((_place, k) => {
                if (show.state.balls[k]?.mode === "off") return [];
                return [{ k, instance, radius, at: show.stage.project(show.ballInWorld(k, instance)) }];
            }),
    );
}
