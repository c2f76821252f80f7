/** Lengths and angles as people type them: a number, with a unit or without. */

import { plain } from "pinik/words.js";

export const LENGTHS = { mm: 0.001, cm: 0.01, m: 1, µm: 1e-6, um: 1e-6 };
const DEGREE = Math.PI / 180;
export const ANGLES = { "°": DEGREE, deg: DEGREE, rad: 1, mrad: 0.001 };

/**
 * The value of a text such as "5" or "0.5 cm" in SI units, or NaN.
 *
 * @param units name → size in the SI unit
 * @param usual the unit of a number without one
 */
export function measured(text, units, usual) {
    const found = /^([-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:e[-+]?\d+)?)\s*(\S*)$/i.exec(text.trim());
    if (!found) return NaN;
    const unit = found[2].toLowerCase() || usual;
    const size = Object.hasOwn(units, unit) ? units[unit] : NaN;
    // Twelve digits, so that 0.3 mm is 0.0003 m and not 0.00029999999999999997.
    return Number((Number(found[1].replace(",", ".")) * size).toPrecision(12));
}

/** What a value outside a range must be, in a unit, such as "from 0.001 to 1000 mm"; "" if it is inside. */
export function outside(value, [low, high], units, unit) {
    if (value >= low && value <= high) return "";
    return `from ${plain(low / units[unit])} to ${plain(high / units[unit])} ${unit}`;
}
