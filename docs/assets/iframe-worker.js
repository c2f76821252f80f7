/* Browsers give no worker to a page that is read from disk, so there the search works in a hidden frame. */

/** What the search needs of a Worker. */
class FrameWorker extends EventTarget {
    constructor(url) {
        super();
        const frame = document.createElement("iframe");
        frame.hidden = true;
        frame.srcdoc = `<script src="${new URL(url, location).href}"></script>`; // an address has no quotation marks
        this._inside = new Promise((resolve) => {
            frame.addEventListener("load", () => resolve(frame.contentWindow));
        });
        this._inside.then((inside) => {
            inside.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", { data }));
        });
        document.documentElement.append(frame);
    }

    postMessage(data) {
        this._inside.then((inside) => inside.dispatchEvent(new MessageEvent("message", { data })));
    }
}

if (location.protocol === "file:") window.Worker = FrameWorker;
