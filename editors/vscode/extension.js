// Starts `apex lsp` and connects the editor with it.

const vscode = require('vscode');
const { LanguageClient } = require('vscode-languageclient/node');

let client;

async function start() {
  const command = vscode.workspace.getConfiguration('apex').get('command');
  const server = { command, args: ['lsp'] };
  client = new LanguageClient('apex', 'Apex', server, { documentSelector: [{ language: 'afg' }] });
  try {
    await client.start();
  } catch (error) {
    vscode.window.showErrorMessage(
      `Apex: \`${command} lsp\` cannot be started (${error.message}). Install it with \`cargo install --path apex-cli\`, or set \`apex.command\`.`,
    );
  }
}

async function stop() {
  const running = client;
  client = undefined;
  if (running?.needsStop()) {
    await running.stop();
  }
}

async function restart() {
  await stop();
  await start();
}

exports.activate = async (context) => {
  context.subscriptions.push(vscode.commands.registerCommand('apex.restart', restart));
  context.subscriptions.push(
    vscode.workspace.onDidChangeConfiguration((change) => change.affectsConfiguration('apex.command') && restart()),
  );
  await start();
};

exports.deactivate = stop;
