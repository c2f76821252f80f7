"""The bridge between pinik and its compiled engine."""
