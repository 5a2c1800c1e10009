"""What a scene does without: that it changes nothing, what it saves, and what a configuration could do without."""
