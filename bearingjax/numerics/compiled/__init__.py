"""Stored programs and batched loops: what is compiled, and how often."""
