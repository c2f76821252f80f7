"""The tables and figures of the thesis and of Welman, computed again with pinik."""
