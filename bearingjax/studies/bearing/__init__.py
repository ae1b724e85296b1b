"""Tables of a bearing that several kinds of scene share."""
