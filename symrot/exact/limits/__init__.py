"""Limits of effort: operations for one claim, polynomial rings for one decision; also the size of a formula."""
