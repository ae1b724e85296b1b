"""Noise and vibration of a bearing."""
