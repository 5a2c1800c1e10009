"""One study a file; each is what a command of the program does."""
