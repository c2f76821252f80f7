/** The methods' equations in MathML, which browsers set themselves. */

const SPACE = "http://www.w3.org/1998/Math/MathML";

function m(tag, ...children) {
    const element = document.createElementNS(SPACE, tag);
    element.append(...children);
    return element;
}

const mi = (name) => m("mi", name);
const mo = (sign) => m("mo", sign);
const row = (...children) => m("mrow", ...children);
const sub = (base, index) => m("msub", base, index);
const sup = (base, power) => m("msup", base, power);
const over = (above, below) => m("mfrac", above, below);
const within = (...children) => row(mo("("), ...children, mo(")"));

/** A matrix or vector, upright and bold. */
function bold(name) {
    const element = mi(name);
    element.setAttribute("mathvariant", "normal");
    element.style.fontWeight = "650";
    return element;
}

const J = () => bold("J");
const e = () => bold("e");
const step = () => row(mi("Δ"), bold("q"));
const transposed = (base) => sup(base, mo("⊤"));
const squared = (base) => sup(base, m("mn", "2"));
const indexed = (base) => sub(base, mi("i"));
const component = () => within(transposed(indexed(bold("u"))), e());
const sum = (below) => (below ? m("munder", mo("∑"), below) : sub(mo("∑"), mi("i")));

const numbered = (number) => sub(mi("k"), m("mn", String(number)));
const effector = () => sub(bold("p"), mi("c"));
const goal = () => sub(bold("p"), mi("d"));

const FORMULAS = {
    ccd: () => [
        row(
            mi("φ"),
            mo("="),
            mi("atan2"),
            within(numbered(3), mo(","), numbered(2), mo("−"), numbered(1)),
        ),
        row(numbered(1), mo("="), within(goal(), mo("·"), bold("a")), within(effector(), mo("·"), bold("a"))),
        row(
            ...[numbered(2), mo("="), goal(), mo("·"), effector(), mo(","), m("mspace")],
            ...[numbered(3), mo("="), bold("a"), mo("·"), within(effector(), mo("×"), goal())],
        ),
    ],
    jt: () => {
        const reached = () => row(J(), transposed(J()), e());
        const product = (a, b) => row(mo("⟨"), a, mo(","), b, mo("⟩"));
        return [
            row(step(), mo("="), mi("α"), transposed(J()), e()),
            row(mi("α"), mo("="), over(product(e(), reached()), product(reached(), reached()))),
        ];
    },
    pinv: () => [
        row(step(), mo("="), sup(J(), mo("†")), e(), mo("+"), within(bold("I"), mo("−"), sup(J(), mo("†")), J()), bold("φ")),
        row(
            sup(J(), mo("†")),
            mo("="),
            sum(row(indexed(mi("σ")), mo(">"), mi("τ"))),
            over(m("mn", "1"), indexed(mi("σ"))),
            indexed(bold("v")),
            transposed(indexed(bold("u"))),
        ),
    ],
    dls: () => [
        row(
            step(),
            mo("="),
            transposed(J()),
            sup(within(J(), transposed(J()), mo("+"), squared(mi("λ")), bold("I")), row(mo("−"), m("mn", "1"))),
            e(),
        ),
        row(
            mo("="),
            sum(),
            over(indexed(mi("σ")), row(squared(indexed(mi("σ"))), mo("+"), squared(mi("λ")))),
            component(),
            indexed(bold("v")),
        ),
    ],
};

/** The equations of a method as <math> elements; none for a method of one's own. */
export function formulas(method) {
    return (FORMULAS[method]?.() ?? []).map((formula) => {
        const math = m("math", formula);
        math.setAttribute("display", "block");
        return math;
    });
}
