/** The keys of the live page. */

import { PRESETS } from "pinik/camera.js";
import { byId } from "pinik/elements.js";

/** The bindings for `Keys`, made from a page's parts. */
export function shortcuts(page) {
    const { controls, show, targets } = page;
    const next = (list, now) => list[(list.indexOf(now) + 1) % list.length];
    const names = (list) => list.map(({ name }) => name);
    const send = (type, fields) => page.connection.send({ type, ...fields });
    const nudge = (event) => page.handles.nudge.press(event.key, targets.selected, event.shiftKey);
    return [
        { keys: [" "], shown: ["Space"], title: "start or stop", act: () => controls.toggleRun() },
        {
            keys: ["."],
            title: "make one step; one iteration while Explain is open",
            act: () => page.lectern.iterate() || controls.step(),
        },
        { keys: ["e"], title: "explain, or close", act: () => page.lectern.toggle() },
        { keys: [","], title: "play the turns of a sweep", act: () => page.lectern.replay() },
        { keys: ["r"], title: "reset", act: () => send("reset") },
        { keys: ["1", "2", "4"], title: "number of robots side by side", act: ({ key }) => controls.view(Number(key)) },
        {
            keys: ["m"],
            title: "next motion of the ball",
            act: () => send("motion", { motion: next(names(page.hello.motions), page.state.motion) }),
        },
        {
            keys: ["c"],
            title: "next curve",
            act: () => send("curve", { curve: next(names(page.hello.curves), page.state.curve) }),
        },
        {
            keys: ["+", "=", "-"],
            shown: ["+", "−"],
            title: "faster, slower",
            act: ({ key }) => controls.changeSpeed(key === "-" ? 0.8 : 1.25),
        },
        { keys: ["l"], title: "joint limits on or off", act: () => send("limits", { on: !page.state.limits }) },
        { keys: ["p"], title: "next method's parameters", act: () => page.cards.openNext() },
        { keys: ["b"], title: "select the next ball", act: () => targets.selectNext() },
        {
            keys: ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"],
            shown: ["←", "→", "↑", "↓"],
            title: "move the ball sideways; Shift: finer",
            act: nudge,
        },
        {
            keys: ["PageUp", "PageDown"],
            shown: ["Page ↑", "Page ↓"],
            title: "move the ball up, down; Shift: finer",
            act: nudge,
        },
        { keys: ["o"], title: "orientation on or off", act: () => targets.toggleOrientation() },
        {
            keys: ["v"],
            title: "next camera view",
            act: () => show.frameAll(true, next(Object.keys(PRESETS), show.camera.preset)),
        },
        { keys: ["0"], title: "all robots in one place, or side by side", act: () => page.lookMenu.turn("overlay") },
        { keys: ["h"], title: "present: hide or show the panel", act: () => page.presentation.turn() },
        { keys: ["w"], title: "whole screen", act: () => page.presentation.turnWholeScreen() },
        { keys: ["f"], title: "show everything", act: () => show.frameAll() },
        { keys: ["t"], title: "next theme: system, light, dark", act: () => page.theme.turn() },
        { keys: ["?"], title: "show this list", act: () => byId("help").showModal() },
    ];
}
