"""MIMo's sense of balance."""
