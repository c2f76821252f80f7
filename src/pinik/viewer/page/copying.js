/** The dialog from which the pose and the question are copied, and into which angles are pasted. */

import { byId, say } from "pinik/elements.js";
import { offer } from "pinik/hands.js";

export class Copying {
    /** @param joints tells which instance is meant */
    constructor(connection, joints) {
        this._connection = connection;
        this._joints = joints;
        this._texts = [];
        byId("copy-open").addEventListener("click", () => this.open());
        byId("copy-what").addEventListener("change", () => this._show());
        byId("copy-button").addEventListener("click", () => this._copy());
        byId("paste-button").addEventListener("click", () => this._paste());
        byId("copy-dialog").addEventListener("click", ({ target }) => {
            if (target === byId("copy-dialog")) byId("copy-dialog").close();
        });
    }

    async open() {
        const instance = this._joints.instance ?? 0;
        byId("copy-dialog").showModal();
        const answer = await fetch(`/api/copy/${instance}.json`);
        this._texts = answer.ok ? await answer.json() : [];
        offer(
            byId("copy-what"),
            this._texts.map(({ name, title }) => [name, title]),
        );
        this._show();
    }

    _show() {
        byId("copy-text").value = this._texts.find(({ name }) => name === byId("copy-what").value)?.text ?? "";
        say(byId("copy-done"), "");
    }

    async _copy() {
        const field = byId("copy-text");
        field.select();
        try {
            await navigator.clipboard.writeText(field.value);
        } catch {
            document.execCommand("copy"); // where the page is not served by this machine or over https
        }
        say(byId("copy-done"), "Copied.");
    }

    _paste() {
        this._connection.send({ type: "paste", instance: this._joints.instance, text: byId("paste-text").value });
        byId("copy-dialog").close();
    }
}
