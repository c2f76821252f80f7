/** What tests and the browser's console see of the page, as `window.pinik`. */

export function inspector(page) {
    const { show } = page;
    return {
        get state() {
            return page.state;
        },
        get table() {
            return page.table;
        },
        get viewer() {
            return show.stage.viewer;
        },
        get show() {
            return show;
        },
        get frames() {
            return show.stage.frames;
        },
        /** What has been drawn of the current robot: "", "skeleton" or "shapes". */
        get drawn() {
            return show.drawn;
        },
        get ready() {
            return show.drawn !== "";
        },
        /** Whether the camera has come to rest. */
        get still() {
            return show.still;
        },
        /** Whether the picture has stopped changing and has been drawn in full detail. */
        get settled() {
            return show.stage.settled;
        },
        /** The middle of one side of a ring around the selected ball in the first instance, as `targetOnScreen`. */
        ringOnScreen(axis, angle) {
            return page.handles.rings.onScreen(axis, angle);
        },
        /** The position of ball k in the first instance, in CSS pixels of the page. */
        targetOnScreen(k) {
            const box = show.stage.element.getBoundingClientRect();
            const { x, y } = show.stage.project(show.ballInWorld(k, 0));
            return { x: box.left + x, y: box.top + y };
        },
    };
}
