/** The cards of all instances. */

import { Card } from "pinik/card.js";

export class Cards {
    constructor(element, connection) {
        this._element = element;
        this._connection = connection;
        this._cards = [];
    }

    setHello(hello) {
        this._hello = hello;
    }

    setState(state) {
        while (this._cards.length > state.instances.length) this._cards.pop().element.remove();
        while (this._cards.length < state.instances.length) {
            const card = new Card(this._cards.length, this._hello, this._connection);
            this._cards.push(card);
            this._element.append(card.element);
        }
        for (const card of this._cards) card.setState(state);
    }

    /** Open the next instance's parameters and close the others; after the last instance, close all. */
    openNext() {
        const open = this._cards.findIndex((card) => card.open);
        this._cards.forEach((card, i) => {
            card.open = i === open + 1;
        });
    }
}
