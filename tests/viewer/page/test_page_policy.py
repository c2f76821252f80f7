"""The page under its own content security policy, which every other test of the page bypasses."""

from __future__ import annotations

import pytest

import pinik
from desk import METHODS, SMALL, Faults, need_browser
from page_fixtures import new_context

NOTE_VIOLATIONS = """
window.violations = [];
document.addEventListener("securitypolicyviolation", ({ violatedDirective, blockedURI, sourceFile }) => {
    window.violations.push(`${violatedDirective}: ${blockedURI} in ${sourceFile}`);
});
"""
# In a task of the page's own: what the debugger evaluates itself is exempt from the policy.
EVALUATE_IN_PAGE = """(text) => new Promise((resolve) => {
    setTimeout(() => {
        try {
            resolve(window.eval(text));
        } catch (error) {
            resolve(error.name);
        }
    });
})"""


@pytest.fixture
def strict_page(browser):
    """A tab that obeys the policy, and its faults."""
    context = new_context(browser, bypass_csp=False, viewport=SMALL)
    faults = Faults(context)
    page = context.new_page()
    page.add_init_script(NOTE_VIOLATIONS)
    yield page, faults
    context.close()


def test_the_page_runs_under_its_policy_and_violates_nothing(strict_page):
    page, faults = strict_page
    expect = need_browser().expect
    with pinik.live("two_link", METHODS, port=0, running=False, motion="hand") as view:
        faults.allow(f"127.0.0.1:{view.port}")
        page.goto(view.url)
        expect(page.get_by_test_id("label-3")).to_contain_text("idle")
        page.get_by_test_id("step").click()
        for i in range(len(METHODS)):
            expect(page.get_by_test_id(f"status-{i}")).to_contain_text("reached")
        assert view.state["step"] == 1
        assert page.evaluate("() => window.violations") == []
        assert faults.left == []


def test_the_policy_refuses_to_evaluate_text(strict_page):
    page, _ = strict_page
    with pinik.live("two_link", ["dls"], port=0, running=False) as view:
        policy = page.goto(view.url).headers["content-security-policy"]
        assert "unsafe-eval" not in policy
        assert page.evaluate(EVALUATE_IN_PAGE, "1 + 1") == "EvalError"
        (violation,) = page.evaluate("() => window.violations")
        assert violation.startswith("script-src: eval")
