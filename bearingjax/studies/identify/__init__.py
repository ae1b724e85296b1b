"""Numbers of a bearing from measurements."""
