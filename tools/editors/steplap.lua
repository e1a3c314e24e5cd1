-- Neovim 0.7 and later: completion and checking of steplap's models by taplo's language server. docs/how-to/write_models_in_an_editor.md
-- Put it into ~/.config/nvim/plugin/. `cmd` is how the server is called: "taplo lsp stdio", or taplo_lsp.js with node.
local cmd = vim.g.steplap_taplo or { "taplo", "lsp", "stdio" }
local client
vim.api.nvim_create_autocmd("FileType", {
  pattern = "toml",
  callback = function(event)
    client = client or vim.lsp.start_client({ name = "taplo", cmd = cmd, root_dir = vim.fn.getcwd() })
    if client then
      vim.lsp.buf_attach_client(event.buf, client)
      vim.bo[event.buf].omnifunc = "v:lua.vim.lsp.omnifunc" -- Ctrl-X Ctrl-O offers what may stand here
    end
  end,
})
