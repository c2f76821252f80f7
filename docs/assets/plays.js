/* Saved animations play in the place of their stills, as soon as somebody sees them. */

const calm = matchMedia("(prefers-reduced-motion: reduce)");

/** Replace a still once the animation shows something; without WebGL, the still stays. */
function play(link) {
    const frame = document.createElement("iframe");
    Object.assign(frame, { src: link.href, title: link.querySelector("img").alt });
    link.append(frame);
    link.addEventListener("click", (event) => event.preventDefault());
    frame.addEventListener("load", () => {
        const since = performance.now();
        const look = setInterval(() => {
            if (isPlaying(frame)) link.classList.add("playing");
            if (link.classList.contains("playing") || performance.now() - since > 10_000) clearInterval(look);
        }, 100);
    });
}

function isPlaying(frame) {
    try {
        return Boolean(frame.contentWindow.pinik?.player);
    } catch {
        return true; // of a site that is read as files, no page may look into another
    }
}

const watcher = new IntersectionObserver((seen) => {
    for (const { isIntersecting, target } of seen) {
        if (!isIntersecting) continue;
        watcher.unobserve(target);
        play(target);
    }
});

/** Animations take the colours that the reader chose for the site: the theme is where the live view keeps its own. */
function tellTheme() {
    try {
        localStorage.setItem("pinik-theme", document.body.dataset.mdColorScheme === "slate" ? "dark" : "light");
    } catch {
        // Without storage, they follow the system.
    }
}

if (document.querySelector("a.plays")) {
    tellTheme();
    new MutationObserver(tellTheme).observe(document.body, { attributeFilter: ["data-md-color-scheme"] });
}
for (const link of document.querySelectorAll("a.plays")) {
    if (!calm.matches) watcher.observe(link);
}
