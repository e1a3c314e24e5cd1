// Nothing of its own: its target has the headers that tests share, compiled once.
