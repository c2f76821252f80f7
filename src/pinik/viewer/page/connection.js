/** The websocket to the server: reconnects by itself, and sends only the newest of frequent messages. */

const FIRST_DELAY = 300; // [ms]
const LONGEST_DELAY = 4000;
const SPACING = 16; // [ms] between two messages of which only the newest matters

export class Connection {
    /** @param handlers onText(message), onBinary(ArrayBuffer), onOpen(), onClose() */
    constructor(handlers) {
        this._handlers = handlers;
        this._delay = FIRST_DELAY;
        this._waiting = new Map();
        this._connect();
    }

    get open() {
        return this._socket.readyState === WebSocket.OPEN;
    }

    _connect() {
        const scheme = location.protocol === "https:" ? "wss" : "ws";
        const socket = new WebSocket(`${scheme}://${location.host}/ws`);
        socket.binaryType = "arraybuffer";
        socket.onopen = () => {
            this._delay = FIRST_DELAY;
            this._handlers.onOpen();
        };
        socket.onmessage = ({ data }) => {
            if (typeof data === "string") this._handlers.onText(JSON.parse(data));
            else this._handlers.onBinary(data);
        };
        socket.onclose = () => {
            this._handlers.onClose();
            setTimeout(() => this._connect(), this._delay);
            this._delay = Math.min(2 * this._delay, LONGEST_DELAY);
        };
        this._socket = socket;
    }

    /** Send now, or drop the message while offline: after reconnecting, the server sends its state anyway. */
    send(message) {
        this.onSend?.(message);
        if (this.open) this._socket.send(JSON.stringify(message));
    }

    /** Send the first message at once, and then only the last one of each 60th of a second. */
    sendNewest(key, message) {
        if (this._waiting.has(key)) {
            this._waiting.set(key, message);
            return;
        }
        this.send(message);
        this._waiting.set(key, null);
        setTimeout(() => this.flush(key), SPACING);
    }

    /** Send the waiting message now. */
    flush(key) {
        const last = this._waiting.get(key);
        this._waiting.delete(key);
        if (last) this.sendNewest(key, last);
    }
}
