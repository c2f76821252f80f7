/** What methods are compared under: figures of one contest say nothing about another. */

export function contest({ generation, limits, tolerance, instances }) {
    const methods = instances.map(({ method, parameters }) => [method, parameters.map(({ value }) => value)]);
    return JSON.stringify([generation, limits, tolerance, methods]);
}
