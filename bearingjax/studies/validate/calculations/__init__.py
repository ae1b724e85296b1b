"""Calculations of validation cases that are no scene: of single contacts, oils, sets.

Each takes the inputs of a case and of one of its rows, in SI, and returns its numbers
in SI by name.
"""
