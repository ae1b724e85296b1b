"""Identification of numbers of a scene from measurements."""
