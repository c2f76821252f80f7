/** The page's first moment: it appears with its robots. A processor that draws it then draws one picture, not twenty. */

const PATIENCE = 1000; // [ms] until it is shown without robots; as in stage.css

/** @param element what is hidden by the class "starting" */
export function openWithRobots(show, element) {
    const { stage } = show;
    stage.held = true;
    const open = () => {
        stage.held = false;
        element.classList.remove("starting");
    };
    show.onComplete = open;
    setTimeout(open, PATIENCE);
}
