"""The interface between pinik and its compiled engine."""
