"""MIMo 3's sense of balance."""
